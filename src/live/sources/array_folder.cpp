// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/array_folder.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "dermis/bytes/devices/serial_ports.hpp"
#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/config_table.hpp"
#include "dermis/bytes/files/text.hpp"
#include "live/sources/likely_sources.hpp"

namespace dermis::live::sources {
namespace {

namespace fs = std::filesystem;
using bytes::devices::SerialPort;

constexpr const char* kSerial = "serial://";

std::string within(const std::string& folder, const char* name) {
  return (fs::path(folder) / name).string();
}

/// "serial:///dev/ttyACM0?baud=9600&layout=x.toml" as its place and its parameters.
struct SplitUri {
  std::string place;
  std::vector<std::string> parameters;

  explicit SplitUri(const std::string& uri) : place(uri.substr(0, uri.find('?'))) {
    for (std::size_t begin = place.size(); begin < uri.size();) {
      const std::size_t end = std::min(uri.find('&', begin + 1), uri.size());
      parameters.push_back(uri.substr(begin + 1, end - begin - 1));
      begin = end;
    }
  }

  /// Takes the parameter out; empty where there is none.
  std::string take(const std::string& name) {
    const auto found = std::ranges::find_if(parameters, [&](const auto& one) { return one.starts_with(name + "="); });
    if (found == parameters.end()) return {};
    std::string value = found->substr(name.size() + 1);
    parameters.erase(found);
    return value;
  }

  [[nodiscard]] std::string text() const {
    std::string uri = place;
    for (const std::string& parameter : parameters) uri += (uri.size() == place.size() ? "?" : "&") + parameter;
    return uri;
  }
};

Result<std::string> read_source(const std::string& folder) {
  const std::string path = within(folder, "source.toml");
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::string();
  Result<bytes::files::ConfigFile> file = bytes::files::ConfigFile::read(path);
  if (!file) return file.error();
  std::string from;
  std::string layout;
  file->text("from", from);
  file->text("layout", layout);
  if (Status read = file->finish(); !read) return read.error();
  if (from.empty() || layout.empty()) return from;
  SplitUri uri(from);
  uri.parameters.push_back("layout=" + within(folder, layout.c_str()));
  return uri.text();
}

/// The newest model; times of files are by the clock of their disk.
std::string newest_model(const std::string& folder) {
  std::string newest;
  fs::file_time_type changed{};
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::error_code gone;
    if (entry.path().extension() != ".safetensors" || !entry.is_regular_file(gone)) continue;
    const fs::file_time_type time = entry.last_write_time(gone);
    if (!newest.empty() && std::pair(time, entry.path().string()) < std::pair(changed, newest)) continue;
    newest = entry.path().string();
    changed = time;
  }
  return newest;
}

std::string lasting_name(const std::string& device) {
  for (const SerialPort& port : bytes::devices::serial_ports()) {
    if (port.device == device) return port.path;
  }
  return device;
}

/// "usb-Arduino_Uno_7573" of "/dev/serial/by-id/usb-Arduino_Uno_7573-if00"; without the number it is the board's kind.
std::string kind_of_board(const std::string& path) {
  const std::string name = fs::path(path).filename().string();
  return name.substr(0, name.rfind('_'));
}

}  // namespace

bool is_array_folder(const std::string& path) {
  std::error_code error;
  return fs::is_directory(path, error) && fs::is_regular_file(within(path, "array.toml"), error);
}

Result<ArrayFolder> read_array_folder(const std::string& path) {
  if (!is_array_folder(path)) return bad_input("'" + path + "': is no folder of an array: it has no array.toml");
  Result<std::string> from = read_source(path);
  if (!from) return from.error();
  ArrayFolder folder{path, newest_model(path), *std::move(from)};
  std::error_code error;
  const std::string suit = within(path, "array.suit.toml");
  if (fs::is_regular_file(suit, error)) folder.model = suit;
  if (folder.model.empty()) folder.model = within(path, "array.toml");
  return folder;
}

Status write_array_source(const std::string& folder, const SourceName& from) {
  SplitUri uri(from.text);
  const std::string layout = uri.take("layout");
  if (uri.place.starts_with(kSerial)) uri.place = kSerial + lasting_name(uri.place.substr(std::string(kSerial).size()));
  std::string text = "# Where the array was last, by which it is found again.\n";
  text += "from = " + bytes::files::quoted_toml(uri.text()) + "\n";
  if (!layout.empty()) {
    const fs::path beside = fs::proximate(layout, folder);
    text += "layout = " + bytes::files::quoted_toml(beside.string()) + "\n";
  }
  Result<bytes::files::AtomicFile> file = bytes::files::AtomicFile::create(within(folder, "source.toml"));
  if (!file) return file.error();
  file->write(text);
  return file->commit();
}

std::vector<SourceName> likely_sources(const ArrayFolder& folder) {
  std::vector<SourceName> likely;
  const Result<SourceName> last = SourceName::parse(folder.from);
  if (!last || folder.from.empty()) return likely;
  if (!last->uri || last->uri->transport != bytes::devices::Transport::serial) return {*last};
  const std::string& path = last->uri->path;
  std::vector<SerialPort> ports = bytes::devices::serial_ports();
  const auto rank = [&](const SerialPort& port) {
    if (port.path == path || port.device == path) return 0;
    return kind_of_board(port.path) == kind_of_board(path) ? 1 : 2;
  };
  std::ranges::stable_sort(ports, {}, rank);
  if (ports.empty() || rank(ports.front()) != 0) likely.push_back(*last);
  for (const SerialPort& port : ports) {
    SplitUri uri(folder.from);
    uri.place = kSerial + port.path;
    if (Result<SourceName> name = SourceName::parse(uri.text())) likely.push_back(*std::move(name));
  }
  return likely;
}

}  // namespace dermis::live::sources
