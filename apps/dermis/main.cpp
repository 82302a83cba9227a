// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fcntl.h>
#include <fmt/core.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>

#include "commands.hpp"
#include "dermis/core/version.hpp"
#include "live_line.hpp"

namespace {

constexpr int kExitFailed = 1;
constexpr int kExitBadInput = 2;

/// A file that is opened must not become the standard error of a process that was started without one.
void fill_standard_descriptors() {
  for (int descriptor = 0; descriptor <= 2; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) == -1) ::open("/dev/null", O_RDWR);  // takes the lowest that is free
  }
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

int run(int argc, char** argv) {
  CLI::App app{"dermis: calibrated force (newtons) from resistive tactile arrays", "dermis"};
  app.set_version_flag("--version", DERMIS_VERSION);
  app.require_subcommand(0, 1);
  dermis::app::Action action;
  dermis::app::add_simulate(app, action);
  dermis::app::add_calibrate(app, action);
  dermis::app::add_run(app, action);
  dermis::app::add_evaluate(app, action);
  dermis::app::add_circuit(app, action);
  dermis::app::add_doctor(app, action);
  dermis::app::add_paper(app, action);
  dermis::app::add_record(app, action);
  dermis::app::add_replay(app, action);
  dermis::app::add_emulate(app, action);
  dermis::app::add_convert(app, action);
  dermis::app::add_info(app, action);
  dermis::app::add_recover(app, action);
  dermis::app::add_image(app, action);
  dermis::app::add_top(app, action);
  dermis::app::add_serve(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    dermis::app::say(fmt::format("dermis: {} (see dermis --help)", first_line(error.what())));
    return kExitBadInput;
  }
  if (!action) {
    dermis::app::say(
        "dermis: name a command: simulate, calibrate, run, evaluate, circuit, doctor, paper, record, replay, "
        "emulate, convert, info, recover, image, top or serve (see dermis --help)");
    return kExitBadInput;
  }
  dermis::Status status = action();
  if (status && std::fflush(stdout) != 0) {
    status = dermis::failed(fmt::format("cannot write the standard output: {}", std::strerror(errno)));
  }
  if (status) return 0;
  dermis::app::say(fmt::format("dermis: {}", status.error().message));
  return status.error().kind == dermis::ErrorKind::bad_input ? kExitBadInput : kExitFailed;
}

}  // namespace

std::string dermis::app::not_negative(const std::string& text) {
  return text.starts_with('-') ? "must not be negative" : "";
}

int main(int argc, char** argv) {
  fill_standard_descriptors();
  // A write beyond a size limit or to a closed pipe becomes an error of write() instead of the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {  // out of memory and the like
    dermis::app::say(fmt::format("dermis: {}", error.what()));
    return kExitFailed;
  }
}
