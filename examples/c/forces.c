/* SPDX-License-Identifier: Apache-2.0 */
/* SPDX-FileCopyrightText: 2026 The dermis authors */
/* Forces of an array from C: one line a frame, in newtons.
 *
 *   forces chest.safetensors serial:///dev/ttyACM0
 */
#include <dermis.h>
#include <stdio.h>

static int failed(const char* what) {
  fprintf(stderr, "%s: %s\n", what, dermis_last_error());
  return 1;
}

int main(int argc, char** argv) {
  dermis_model* model = NULL;
  dermis_pipeline* pipeline = NULL;
  dermis_source* source = NULL;
  dermis_raw_frame raw;
  dermis_force_frame force;
  dermis_status status = DERMIS_OK;
  size_t k = 0;
  if (argc != 3) {
    fprintf(stderr, "usage: forces MODEL SOURCE\n");
    return 2;
  }
  if (dermis_model_read(argv[1], &model) != DERMIS_OK) return failed("model");
  if (dermis_pipeline_create(model, &pipeline) != DERMIS_OK) return failed("pipeline");
  if (dermis_source_open(argv[2], model, &source) != DERMIS_OK) return failed("source");

  while ((status = dermis_source_next(source, &raw)) == DERMIS_OK) {
    if (dermis_pipeline_process(pipeline, &raw, &force) != DERMIS_OK) return failed("frame");
    for (k = 0; k < force.count; ++k) printf(k == 0 ? "%.9g" : ",%.9g", force.newtons[k]);
    printf("\n");
  }

  dermis_source_free(source);
  dermis_pipeline_free(pipeline);
  dermis_model_free(model);
  return status == DERMIS_END ? 0 : failed("source");
}
