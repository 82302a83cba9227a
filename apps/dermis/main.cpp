// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fcntl.h>
#include <fmt/core.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "commands.hpp"
#include "dermis/bytes/files/output_place.hpp"
#include "file_places.hpp"
#include "lost_input.hpp"
#include "secrets.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

constexpr int kExitFailed = 1;
constexpr int kExitBadInput = 2;
constexpr int kExitReaderGone = 128 + SIGPIPE;

constexpr const char* kBegin = "Begin";
constexpr const char* kCalibrate = "Calibrate";
constexpr const char* kUse = "Use";
constexpr const char* kLookAfter = "Look after";
constexpr const char* kExchange = "Exchange";
constexpr const char* kFleets = "Fleets";
constexpr const char* kDesign = "Design and research";

constexpr std::array kCommands{
    CommandEntry{"serve", "Show an array or a suit live in the browser, calibrate it there, and stream it", kBegin,
                 add_serve},
    CommandEntry{"describe", "Write the layout of bytes that dermis does not know", kBegin, add_describe},
    CommandEntry{"record", "Record a device, or any other source of frames", kBegin, add_record},
    CommandEntry{"simulate", "Simulate an array: frames.csv and loads.csv (the true loads)", kBegin, add_simulate},
    CommandEntry{"calibrate", "Learn a model from frames with known loads", kCalibrate, add_calibrate},
    CommandEntry{"evaluate", "Measure accuracy on known loads, and compare with look-up tables", kCalibrate,
                 add_evaluate},
    CommandEntry{"run", "Turn raw counts into newtons per taxel, and into contacts", kUse, add_run},
    CommandEntry{"top", "Show a live heat map in the terminal, until q or Ctrl-C", kUse, add_top},
    CommandEntry{"watch", "Compare forces with limits, and stop a program if one is crossed", kUse, add_watch},
    CommandEntry{"recognise", "Learn poses or gestures, and name those of a stream, or answer \"unknown\"", kUse,
                 add_recognise},
    CommandEntry{"doctor", "Check an array and its calibration by its counts or a known weight; mend the gains",
                 kLookAfter, add_doctor},
    CommandEntry{"info", "Show what a file of frames or a model holds; repair a recording", kLookAfter, add_info},
    CommandEntry{"replay", "Play a recording at the pace of its frames, as counts or newtons", kExchange, add_replay},
    CommandEntry{"convert", "Convert frames to another file format, by the ending of the name", kExchange, add_convert},
    CommandEntry{"image", "Draw a frame as PNG or SVG, or some seconds as a film (GIF)", kExchange, add_image},
    CommandEntry{"dataset", "Turn recordings into episodes for learning: LeRobot, HDF5, zarr", kExchange, add_dataset},
    CommandEntry{"emulate", "Play a device from a recording, to develop without hardware", kExchange, add_emulate},
    CommandEntry{"fleet", "Keep the frames of many robots on a hub, and see how they do", kFleets, add_fleet},
    CommandEntry{"circuit", "Compute a readout circuit, for people who design one", kDesign, add_circuit},
    CommandEntry{"paper", "Reproduce the paper, and judge its networks beside dermis", kDesign, add_paper},
};

/// A file that is opened must not become the standard error of a process that was started without one.
void fill_standard_descriptors() {
  for (int descriptor = 0; descriptor <= 2; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) == -1) ::open("/dev/null", O_RDWR);  // takes the lowest that is free
  }
}

/// The action's own output is complete only when it has left the process.
Result<int> perform(const Action& action) {
  Result<int> status = action();
  if (status && std::fflush(stdout) != 0) {
    return cannot_print(errno);
  }
  return status;
}

/// Whoever reads the standard output has enough, as head has after some lines.
bool has_reader_gone(const Error& error) {
  return error.message == cannot_print(EPIPE).message ||
         error.message == bytes::files::cannot_write(kStandardOutput, EPIPE).message;
}

int exit_status(const Error& error) {
  print_notice(fmt::format("dermis: {}{}", error.field.empty() ? "" : "--", error.message));
  return error.kind == ErrorKind::bad_input ? kExitBadInput : kExitFailed;
}

int run(std::span<char* const> given) {
  Result<std::vector<std::string>> arguments = take_arguments(given);
  if (!arguments) return exit_status(arguments.error());
  std::vector<char*> words;
  for (std::string& argument : *arguments) words.push_back(argument.data());
  const Result<Action> action = parse_command_line(static_cast<int>(words.size()), words.data(), kCommands);
  if (!action) return exit_status(action.error());
  if (!*action) return 0;
  const Result<int> status = perform(*action);
  bytes::files::release_claims();
  if (!status && has_reader_gone(status.error())) return kExitReaderGone;
  const std::string lost = losses();
  if (lost.empty()) return status ? *status : exit_status(status.error());
  if (!status) return exit_status({.kind = status.error().kind, .message = lost + "; " + status.error().message});
  const int lossy = exit_status(failed(lost));
  return *status == 0 ? lossy : *status;
}

}  // namespace
}  // namespace dermis::app

int main(int argc, char** argv) {
  dermis::app::fill_standard_descriptors();
  // A write beyond a size limit or to a closed pipe becomes an error of write() instead of the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return dermis::app::run({argv, static_cast<std::size_t>(argc)});
  } catch (const std::system_error& error) {  // of fmt::print()
    if (error.code() == std::errc::broken_pipe) return dermis::app::kExitReaderGone;
    dermis::app::print_notice(fmt::format("dermis: {}", error.what()));
    return dermis::app::kExitFailed;
  } catch (const std::exception& error) {  // out of memory and the like
    dermis::app::print_notice(fmt::format("dermis: {}", error.what()));
    return dermis::app::kExitFailed;
  }
}
