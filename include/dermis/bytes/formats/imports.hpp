// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/bytes/formats/import_options.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

/// The frames in files of other systems, a function a format; docs/frame-files.md describes what each reads. A last
/// frame that is cut is left out, with a notice. The memory is that of a frame and of a line, at most 32 MiB, unless
/// said otherwise. `name` stands for the path in messages. Files without times need options.rate_hz.
namespace dermis::bytes::formats {

/// Recordings of the Weiss DSA, the tactile sensors of a SCHUNK SDH hand. They are XML, usually compressed by bzip2,
/// with the counts of all matrices in one run-length code a frame. options.array is the number of the matrix, from 0,
/// where there are several. If the file has the temperatures of the hand, a frame of matrix m has the last one of its
/// axis (1 + m). The memory is that of a frame and of the temperatures, at most 16 MiB. `in` must be able to seek.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_dsa(std::unique_ptr<std::istream> in, const std::string& name,
                                                            const ImportOptions& options);

/// Exports of novel (pliance, pedar): after a head the line "time[secs]", 1, 2, 3 and so on, then a line of kilopascals
/// a frame. The file does not tell where a sensor is: frames have one row, or the shape of options.shape, row by row.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_novel_asc(std::unique_ptr<std::istream> in,
                                                                  const std::string& name,
                                                                  const ImportOptions& options);

/// Listings of novel (emed, pliance): pages with "Pict-No.: 7" and a table of kilopascals. The first line has the
/// numbers of the columns and the first column those of the rows, both counted from 1 on the whole platform. Pages of
/// the same picture are one frame. MPP and MVP, the sums of a measurement, are skipped, and so are sums of force. Cells
/// that a table does not have are 0. Where options.shape is given, a table lies at its place on the platform; else the
/// frames are the smallest rectangle that holds all tables. `in` must be able to seek.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_novel_lst(std::unique_ptr<std::istream> in,
                                                                  const std::string& name,
                                                                  const ImportOptions& options);

/// Arrays of NumPy in a zip archive. If there are several, options.array names the one with the frames. It is read as
/// files/npy.hpp does, with the times of another that files/array_frames.hpp names, or the rate. The memory is that of
/// a frame and of the archive's list of contents, at most 16 MiB. `in` must be able to seek.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_npz(std::unique_ptr<std::istream> in, const std::string& name,
                                                            const ImportOptions& options);

/// Frames as they come over I2C from controllers that pack their readings. A reading has 10 bits, row by row, the
/// highest bit first, without a gap, so 4 readings have 5 bytes. A frame begins with a byte of its own. The file has
/// neither shape nor times.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_packed10(std::unique_ptr<std::istream> in,
                                                                 const std::string& name, const ImportOptions& options);

/// ASCII exports of Tekscan (I-Scan, F-Scan, Conformat): keys such as ROWS, COLS, SECONDS_PER_FRAME and UNITS, then
/// "Frame 1" and a line of numbers a row. Pressures of any unit come as kilopascals, forces as newtons, UNITS RAW as it
/// is; "B", a cell outside the sensor, as NaN.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_tekscan(std::unique_ptr<std::istream> in,
                                                                const std::string& name, const ImportOptions& options);

/// Blocks of lines with numbers: a line a row, with commas, semicolons, tabs or blanks between the values. An empty
/// value is a missing reading (NaN). Blocks end at a line without numbers (blank, "# frame 7", a header). If the shape
/// is given, they also end after its rows; otherwise the first block gives the shape. There are no times. The memory is
/// that of two frames and of a line.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_text_matrix(std::unique_ptr<std::istream> in,
                                                                    const std::string& name,
                                                                    const ImportOptions& options);

/// ASCII exports of XSENSOR (.csv), with or without quotes. Each FRAME has its Date and Time. Each SENSOR has its Rows,
/// Columns and the pressures below SENSELS. Pressures of any unit come as kilopascals, an empty cell as NaN.
/// options.array names one of several sensors. Times count from 1970 where there is a date, by the clock of the wall
/// where it was recorded. Groups of sensels are passed over. `in` must be able to
/// seek.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_xsensor(std::unique_ptr<std::istream> in,
                                                                const std::string& name, const ImportOptions& options);

/// A picture whose grey levels are readings: [shape.rows, shape.cols], the first row at the top.
struct GreyPicture {
  FrameShape shape;
  std::vector<std::uint16_t> levels;  ///< Values as in the file: 0 ... 255, with 16 bits 0 ... 65535.
};

/// Reads a PNG of grey levels, of 1 to 16 bits; transparency is left out. Fails on colours, and on more than 1024 rows
/// or columns. Thread-safe.
[[nodiscard]] Result<GreyPicture> read_grey_png(std::string_view bytes, const std::string& name);

/// A folder of such pictures, one a frame, in the order of the numbers in their names (frame2.png before frame10.png),
/// or a single one. There are no times. The memory is that of a frame, of a file, at most 16 MiB, and of the names.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_png_stack(const std::string& path,
                                                                  const ImportOptions& options);

}  // namespace dermis::bytes::formats
