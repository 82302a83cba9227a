// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: 01_run_pipeline MODEL FRAMES.csv
// Raw counts in, newtons out: prints the total force and the strongest taxel of every frame.
#include <algorithm>
#include <cstdio>

#include "dermis/bytes/files/frames_csv.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"

namespace {

int fail(const dermis::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return fail(dermis::bad_input("usage: 01_run_pipeline MODEL FRAMES.csv"));
  const auto model = dermis::bytes::models::read_model(argv[1]);
  if (!model) return fail(model.error());
  auto pipeline = dermis::touch::pipeline::Pipeline::create(*model);
  if (!pipeline) return fail(pipeline.error());
  const auto source =
      dermis::bytes::files::FramesCsvReader::open(argv[2], dermis::FrameShape{model->array.rows, model->array.cols});
  if (!source) return fail(source.error());

  dermis::RawFrame raw;      // counts, with the temperature and the supply where they are known
  dermis::ForceFrame force;  // newtons per taxel, row by row, and a status
  for (;;) {
    const auto more = (*source)->next(raw);
    if (!more) return fail(more.error());
    if (!*more) return 0;
    pipeline->process(raw, force);
    const auto strongest = std::max_element(force.newtons.begin(), force.newtons.end()) - force.newtons.begin();
    const auto taxel = static_cast<std::size_t>(strongest);
    std::printf("%.3f s  %-12s total %7.2f N  strongest %s %6.2f N\n",
                std::chrono::duration<double>(force.time).count(), dermis::to_string(force.status).c_str(),
                force.total().newtons, model->array.taxel_name(taxel).c_str(),
                static_cast<double>(force.newtons[taxel]));
  }
}
