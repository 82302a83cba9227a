// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: 05_serve_array SOURCE MODEL [SECONDS]
// Serves an array live until Ctrl-C: what `dermis serve` streams (docs/stream.md), for Foxglove and every client of its
// protocol. SOURCE is a device, such as serial:///dev/ttyACM0, or the simulator: 'sim:contacts?rate=100'.
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "dermis/bytes/models/model_file.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "dermis/out/serve/session.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace {

std::atomic<bool> stop = false;

int fail(const dermis::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return fail(dermis::bad_input("usage: 05_serve_array SOURCE MODEL [SECONDS]"));
  for (const int signal : {SIGINT, SIGALRM}) std::signal(signal, [](int) { stop = true; });
  if (argc > 3) alarm(static_cast<unsigned>(std::atoi(argv[3])));

  auto model = dermis::bytes::models::read_model(argv[2]);
  if (!model) return fail(model.error());
  auto source = dermis::live::sources::open_source(argv[1], {.array = &model->array, .stop = &stop});
  if (!source) return fail(source.error());
  auto suit = dermis::out::serve::suit_of_one(*std::move(source), *std::move(model));
  if (!suit) return fail(suit.error());
  dermis::out::serve::SessionOptions options;
  options.server.port = 0;  // any that is free
  const auto session = dermis::out::serve::Session::create(*std::move(suit), options);
  if (!session) return fail(session.error());
  std::printf("serving at ws://127.0.0.1:%d/\n", (*session)->port());
  const auto ended = (*session)->run(stop);
  return ended ? 0 : fail(ended.error());
}
