// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "bytes/formats/imported_frame.hpp"
#include "bytes/formats/text_lines.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/formats/imports.hpp"

namespace dermis::bytes::formats {
namespace {

constexpr std::size_t kMostSensors = 100;
constexpr std::size_t kMostNameBytes = 200;

/// "2022 Aug 16", since 1970.
std::optional<Nanos> parse_date(std::string_view text) {
  constexpr std::array<std::string_view, 12> kMonths{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                     "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  Cells cells(text, Cells::Separator::any);
  std::array<std::string_view, 3> parts;
  for (std::string_view& part : parts) static_cast<void>(cells.next_filled(part));
  std::size_t year = 0;
  std::size_t day = 0;
  const auto* const month = std::find(kMonths.begin(), kMonths.end(), parts[1]);
  if (!files::parse_number(parts[0], year) || !files::parse_number(parts[2], day) || month == kMonths.end()) return {};
  if (year < 1970 || year > 2200) return {};
  const std::chrono::year_month_day date(std::chrono::year(static_cast<int>(year)),
                                         std::chrono::month(static_cast<unsigned>(month - kMonths.begin()) + 1),
                                         std::chrono::day(static_cast<unsigned>(std::min<std::size_t>(day, 255))));
  if (!date.ok()) return {};
  return std::chrono::sys_days(date).time_since_epoch();
}

/// "08:21:17.982", or seconds.
std::optional<Nanos> parse_time(std::string_view text) {
  Nanos time{};
  for (std::size_t colon = text.find(':'); colon != std::string_view::npos; colon = text.find(':')) {
    std::size_t part = 0;
    if (!files::parse_number(text.substr(0, colon), part) || part > 59 || time > std::chrono::hours(1)) return {};
    time = 60 * (time + std::chrono::seconds(part));
    text.remove_prefix(colon + 1);
  }
  Nanos seconds{};
  if (!files::parse_seconds(text, seconds)) return {};
  return time + seconds;
}

/// The lines above the pressures.
struct Heading {
  std::string sensor;
  FrameShape shape;
  std::optional<Nanos> date;
  std::optional<Nanos> time;
  double factor = 1.0;
  std::size_t frame = 0;  ///< How many began so far.
  bool is_group = false;  ///< The pressures are those of some sensels, again.
};

struct Sensor {
  std::string name;
  FrameShape shape;
};

class Xsensor final : public FrameSource {
 public:
  Xsensor(std::unique_ptr<std::istream> in, const std::string& name, const ImportOptions& options)
      : lines_(std::move(in), name), options_(options) {}

  /// Looks through the first frame, and begins again.
  Status open() {
    std::vector<Sensor> sensors;
    while (heading_.frame < 2) {
      const Result<bool> more = find_pressures();
      if (!more) return more.error();
      if (!*more) break;
      if (heading_.frame < 2) sensors.push_back({heading_.sensor, heading_.shape});
      if (sensors.size() > kMostSensors) return lines_.error("has more than 100 sensors in a frame");
    }
    if (sensors.empty()) return lines_.error("the file ends before its first SENSELS");
    if (Status chosen = choose(sensors); !chosen) return chosen;
    if (Status begun = lines_.rewind(); !begun) return begun;
    heading_ = {};
    return check_shape(lines_.name(), sensor_.shape, options_.shape);
  }

  Result<bool> next(RawFrame& frame) override {
    do {
      Result<bool> more = find_pressures();
      if (!more || !*more) return more;
    } while (heading_.sensor != sensor_.name);
    if (heading_.shape != sensor_.shape) return lines_.error("the sensor has another number of rows and columns now");
    const Result<Nanos> time = time_of_frame();
    if (!time) return time.error();
    begin_frame(frame, *time);
    last_time_ = *time;
    frame.counts.resize(sensor_.shape.taxel_count());
    for (std::size_t row = 0; row < sensor_.shape.rows; ++row) {
      const auto counts = std::span(frame.counts).subspan(row * sensor_.shape.cols, sensor_.shape.cols);
      Result<bool> read = read_row(counts);
      if (!read || !*read) return read;
    }
    for (float& count : frame.counts) count = static_cast<float>(static_cast<double>(count) * heading_.factor);
    ++frames_;
    return true;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override { return sensor_.shape; }
  [[nodiscard]] std::string place() const override { return lines_.place(); }

 private:
  Status choose(const std::vector<Sensor>& sensors) {
    const auto found = std::find_if(sensors.begin(), sensors.end(),
                                    [&](const Sensor& sensor) { return sensor.name == options_.array; });
    if (options_.array.empty() && sensors.size() == 1) {
      sensor_ = sensors.front();
    } else if (found != sensors.end()) {
      sensor_ = *found;
    } else {
      std::string names;
      for (const Sensor& sensor : sensors) names += (names.empty() ? "" : ", ") + files::in_quotes(sensor.name);
      const std::string which =
          options_.array.empty() ? "name one" : "has no sensor " + files::in_quotes(options_.array);
      return bad_input(lines_.name() + ": " + which + ", as " +
                       files::in_quotes(lines_.name() + "#" + sensors[0].name) + "; it has: " + names);
    }
    return Done{};
  }

  [[nodiscard]] Result<Nanos> time_of_frame() const {
    if (!heading_.time) return lines_.error("the frame has no Time");
    const bool is_in_day = *heading_.time >= Nanos{} && *heading_.time <= std::chrono::hours(24);
    if (heading_.date && !is_in_day) return lines_.error("the Time of the frame is not in the day of its Date");
    const Nanos time = heading_.date.value_or(Nanos{}) + *heading_.time;
    if (last_time_ && time < *last_time_) return lines_.error("the Time of the frame is before that of the last one");
    return time;
  }

  /// Reads up to the line SENSELS of the next sensor; false at the end.
  Result<bool> find_pressures() {
    while (true) {
      std::string_view line;
      Result<bool> more = lines_.next(line);
      if (!more || !*more) return more;
      Cells cells(line, Cells::Separator::comma);
      std::string_view key;
      std::string_view value;
      if (!cells.next(key)) continue;
      static_cast<void>(cells.next(value));
      if (key.ends_with(':')) key.remove_suffix(1);
      if (key == "SENSELS" && !heading_.is_group) return true;
      if (const Status read = read_heading(key, value); !read) {
        if (lines_.was_cut() && frames_ > 0) return leave_out();
        return read.error();
      }
    }
  }

  Status read_heading(std::string_view key, std::string_view value) {
    bool is_right = true;
    if (key == "FRAME") {
      ++heading_.frame;
      heading_.time.reset();
      heading_.date.reset();
      heading_.is_group = false;
    } else if (key == "SENSOR") {
      if (value.size() > kMostNameBytes) return lines_.error("the name of the sensor is longer than 200 bytes");
      heading_.sensor = value;
      heading_.is_group = false;
    } else if (key == "GROUP") {
      heading_.is_group = true;
    } else if (key == "Rows") {
      is_right = files::parse_number(value, heading_.shape.rows);
    } else if (key == "Columns") {
      is_right = files::parse_number(value, heading_.shape.cols);
    } else if (key == "Date") {
      heading_.date = parse_date(value);
      if (!heading_.date && heading_.frame > 0)
        return lines_.error("Date " + files::in_quotes(value) + " is none like '2022 Aug 16'");
    } else if (key == "Time") {
      heading_.time = parse_time(value);
      is_right = heading_.time.has_value();
    } else if (key == "Units") {
      const std::optional<double> factor = factor_of_unit(value);
      if (!factor)
        return lines_.error("Units " + files::in_quotes(value) + " are none that are known: " + known_units());
      heading_.factor = *factor;
    }
    if (is_right) return Done{};
    return lines_.error(std::string(key) + " " + files::in_quotes(value) + " is not one that is known");
  }

  /// False where the text ends within the row. Exports that went through a spreadsheet have empty lines between.
  Result<bool> read_row(std::span<float> row) {
    std::string_view line;
    bool is_empty = true;
    while (is_empty) {
      const Result<bool> more = lines_.next(line);
      if (!more) return more.error();
      if (!*more) return leave_out();
      is_empty = line.find_first_not_of(", \t\"") == std::string_view::npos;
    }
    const Status read = parse_row(line, Cells::Separator::comma, row);
    if (read && !lines_.ends_in_comma()) return true;
    if (lines_.was_cut()) return leave_out();
    return lines_.error(read.error().message);
  }

  Result<bool> leave_out() {
    tell_cut(options_, lines_.place(), frames_);
    return false;
  }

  TextLines lines_;
  ImportOptions options_;
  Sensor sensor_;
  Heading heading_;
  std::optional<Nanos> last_time_;
  std::size_t frames_ = 0;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> open_xsensor(std::unique_ptr<std::istream> in, const std::string& name,
                                                  const ImportOptions& options) {
  return open_as<Xsensor>(std::move(in), name, options);
}

}  // namespace dermis::bytes::formats
