/* SPDX-License-Identifier: Apache-2.0 */
/* SPDX-FileCopyrightText: 2026 The dermis authors */
/* libdermis_c as another language loads it: by dlopen, with wrong arguments first, then with contacts. */
#define _POSIX_C_SOURCE 200809L  // NOLINT(readability-identifier-naming): its name
#include <dermis.h>
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void check(int holds, const char* what) {
  if (holds) return;
  fprintf(stderr, "does not hold: %s\n", what);
  exit(1);
}

static void* library;

/* ISO C has no cast from an object's address to a function's; POSIX promises that the bytes are the same. */
/* NOLINTBEGIN(bugprone-macro-parentheses): a name cannot be in any */
#define FUNCTION(name)                             \
  __typeof__(&name) name##_;                       \
  {                                                \
    void* const symbol = dlsym(library, #name);    \
    check(symbol != NULL, #name);                  \
    memcpy(&name##_, &symbol, sizeof symbol);      \
  }
/* NOLINTEND(bugprone-macro-parentheses) */

int main(int argc, char** argv) {
  dermis_model* model = (dermis_model*)argv;
  dermis_pipeline* pipeline = NULL;
  dermis_tracker* tracker = NULL;
  dermis_source* source = NULL;
  dermis_raw_frame raw;
  dermis_force_frame force;
  dermis_total total;
  dermis_total half;
  dermis_total rest;
  uint8_t mask[12] = {1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0};
  uint8_t others[12] = {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1};
  const dermis_contact* contacts = NULL;
  size_t count = 0;
  size_t found = 0;
  check(argc == 4, "usage: by_dlopen LIBRARY MODEL FRAMES");
  library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
  check(library != NULL, "dlopen");
  FUNCTION(dermis_last_error)
  FUNCTION(dermis_model_read)
  FUNCTION(dermis_model_free)
  FUNCTION(dermis_model_rows)
  FUNCTION(dermis_model_name)
  FUNCTION(dermis_pipeline_create)
  FUNCTION(dermis_pipeline_free)
  FUNCTION(dermis_pipeline_process)
  FUNCTION(dermis_pipeline_total)
  FUNCTION(dermis_tracker_create)
  FUNCTION(dermis_tracker_free)
  FUNCTION(dermis_tracker_process)
  FUNCTION(dermis_source_open)
  FUNCTION(dermis_source_next)
  FUNCTION(dermis_source_stop)
  FUNCTION(dermis_source_free)

  check(strcmp(dermis_last_error_(), "") == 0, "there is no error at first");
  check(dermis_model_read_("/nothing", &model) == DERMIS_BAD_INPUT && model == NULL, "a missing file is bad input");
  check(strstr(dermis_last_error_(), "/nothing") != NULL, "the error names the file");
  check(strchr(dermis_last_error_(), '\n') == NULL, "an error is one line");
  check(dermis_model_read_(NULL, &model) == DERMIS_BAD_INPUT, "a path must be there");
  check(dermis_pipeline_create_(NULL, &pipeline) == DERMIS_BAD_INPUT && pipeline == NULL, "a model must be there");
  check(dermis_source_open_("sim:nothing", NULL, &source) == DERMIS_BAD_INPUT && source == NULL, "a scene must exist");
  check(dermis_model_rows_(NULL) == 0 && strcmp(dermis_model_name_(NULL), "") == 0, "no model has no rows");
  dermis_model_free_(NULL);
  dermis_pipeline_free_(NULL);
  dermis_tracker_free_(NULL);
  dermis_source_free_(NULL);
  dermis_source_stop_(NULL);

  check(dermis_model_read_(argv[2], &model) == DERMIS_OK, "the model is read");
  check(dermis_pipeline_create_(model, &pipeline) == DERMIS_OK, "a pipeline is made");
  check(dermis_tracker_create_(model, &tracker) == DERMIS_OK, "a tracker is made");
  check(dermis_source_open_(argv[3], model, &source) == DERMIS_OK, "the frames are opened");
  check(strcmp(dermis_model_name_(model), "pad") == 0, "the name of the array");
  dermis_model_free_(model); /* nobody needs it any more */
  check(dermis_tracker_process_(tracker, pipeline, &contacts, &count) == DERMIS_OK && count == 0, "no frame, no contact");
  while (dermis_source_next_(source, &raw) == DERMIS_OK) {
    check(dermis_pipeline_process_(pipeline, &raw, &force) == DERMIS_OK, "a frame is processed");
    check(dermis_pipeline_total_(pipeline, NULL, 0, &total) == DERMIS_OK, "forces are summed up");
    check(total.sigma_newtons > 0.0 && total.left_out == 0, "a sum has a standard deviation");
    check(dermis_pipeline_total_(pipeline, mask, 12, &half) == DERMIS_OK, "half of them");
    check(dermis_pipeline_total_(pipeline, others, 12, &rest) == DERMIS_OK, "the other half");
    check(fabs(half.newtons + rest.newtons - total.newtons) < 1e-4, "both halves are the whole");
    check(dermis_tracker_process_(tracker, pipeline, &contacts, &count) == DERMIS_OK, "contacts are found");
    found += count;
    if (count > 0) check(contacts[0].force_n >= 0.0 && contacts[0].sigma_force_n > 0.0, "a contact has a force");
  }
  check(found > 0, "there are contacts");
  check(dermis_pipeline_total_(pipeline, mask, 3, &half) == DERMIS_BAD_INPUT, "a mask fits the array");
  check(dermis_pipeline_total_(NULL, NULL, 0, &half) == DERMIS_BAD_INPUT, "a pipeline must be there");
  raw.count = 3;
  check(dermis_pipeline_process_(pipeline, &raw, &force) == DERMIS_OK && (force.status & DERMIS_FRAME_REJECTED) != 0,
        "a frame of another shape is rejected");
  check(dermis_pipeline_process_(pipeline, NULL, &force) == DERMIS_BAD_INPUT, "a frame must be there");
  dermis_source_free_(source);
  check(dermis_source_open_("sim:contacts?rate=10", NULL, &source) == DERMIS_OK, "a live source is opened");
  dermis_source_stop_(source);
  while (dermis_source_next_(source, &raw) == DERMIS_OK) {
  }
  dermis_source_free_(source);
  dermis_tracker_free_(tracker);
  dermis_pipeline_free_(pipeline);
  return 0;
}
