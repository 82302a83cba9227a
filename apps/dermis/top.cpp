// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "commands.hpp"
#include "dermis/out/report/terminal_picture.hpp"
#include "source_options.hpp"
#include "stop_flag.hpp"
#include "views/array_view.hpp"
#include "views/view_player.hpp"

namespace dermis::app {
namespace {

constexpr std::chrono::milliseconds kRedrawTime{50};

struct TopOptions {
  std::string from;
  std::string model;
  std::optional<double> high;
};

out::report::TerminalColours colours_of_terminal() {
  const auto value = [](const char* name) {
    const char* const text = std::getenv(name);
    return std::string_view(text == nullptr ? "" : text);
  };
  const std::string_view term = value("TERM");
  if (!value("NO_COLOR").empty() || term.empty() || term == "dumb") return out::report::TerminalColours::without;
  if (value("COLORTERM") == "truecolor" || value("COLORTERM") == "24bit") return out::report::TerminalColours::rgb;
  return term.find("256color") == std::string_view::npos ? out::report::TerminalColours::without
                                                         : out::report::TerminalColours::cube;
}

out::report::TerminalSize size_of_terminal() {
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_row == 0 || size.ws_col == 0) return {};
  return {size.ws_row, size.ws_col};
}

/// False where the terminal has gone.
bool put(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return false;
    bytes.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
  }
  return true;
}

/// The terminal's other screen, without cursor; its own comes back at the end.
class OtherScreen {
 public:
  OtherScreen() { put("\x1b[?1049h\x1b[?25l\x1b[2J"); }
  OtherScreen(const OtherScreen&) = delete;
  OtherScreen& operator=(const OtherScreen&) = delete;
  ~OtherScreen() { put("\x1b[0m\x1b[?25h\x1b[?1049l"); }
};

/// Keys as they are pressed, without an echo; the terminal is as before at the end.
class Keys {
 public:
  Keys() : is_terminal_(::tcgetattr(STDIN_FILENO, &before_) == 0) {
    if (!is_terminal_) return;
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;
  ~Keys() {
    if (is_terminal_) ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }

  /// Whether `key` was pressed since the last call.
  [[nodiscard]] bool pressed(char key) const {
    bool found = false;
    char next = 0;
    while (is_terminal_ && ::read(STDIN_FILENO, &next, 1) == 1) found = found || next == key;
    return found;
  }

 private:
  termios before_{};
  bool is_terminal_;
};

Status show(views::ArrayView& view, const TopOptions& options) {
  const out::report::TerminalColours colours = colours_of_terminal();
  const OtherScreen screen;
  const Keys keys;
  const views::ViewPlayer player(view, stop_flag(), options.high);
  while (!stop_flag().load() && !keys.pressed('q')) {
    const out::report::TerminalPicture picture = player.picture();
    const std::string screen_text = picture.values.empty()
                                        ? "waiting for the first frame\x1b[K"
                                        : out::report::terminal_screen(picture, size_of_terminal(), colours);
    if (!put("\x1b[H" + screen_text + "\x1b[J")) break;
    if (Status status = player.status(); !status) return status;
    std::this_thread::sleep_for(kRedrawTime);
  }
  return Done{};
}

Status top(const TopOptions& options) {
  if (::isatty(STDOUT_FILENO) == 0) {
    return bad_input("top: the standard output is no terminal; 'dermis image' draws files, 'dermis run' writes tables");
  }
  if (options.high && !(*options.high > 0.0 && std::isfinite(*options.high))) {
    return bad_input("--high: must be more than 0");
  }
  static_cast<void>(stop_flag());  // from here on, Ctrl-C ends the show and not the process
  const Result<std::unique_ptr<views::ArrayView>> view =
      views::ArrayView::open(options.from, options.model, source_options());
  if (!view) return view.error();
  return show(**view, options);
}

}  // namespace

void add_top(Command& command) {
  auto options = std::make_shared<TopOptions>();
  command.input("--from", options->from, "URI of a device or of the simulator, or a recording").required();
  command.input_file(
      "--model", options->model,
      "Model file, or array.toml where readings are forces: shows newtons and contacts instead of counts");
  command.option("--high", options->high, "End of the colour scale [N, or counts]; by default it grows when needed");
  command.action([options] { return top(*options); });
}

}  // namespace dermis::app
