/* SPDX-License-Identifier: Apache-2.0 */
/* SPDX-FileCopyrightText: 2026 The dermis authors */
#ifndef DERMIS_H
#define DERMIS_H

#include <stddef.h>
#include <stdint.h>

/* dermis for C, and for every language that calls C: raw counts of a tactile array in, newtons per taxel out.
 *
 * Handles are opaque. A function that makes one sets it to NULL if it fails. A function that frees one takes NULL.
 * No exception crosses this interface. Errors are a dermis_status; dermis_last_error() gives the line that belongs to
 * it. Shapes are [rows, cols], row-major. Units are SI; temperatures are in Celsius, times in nanoseconds.
 *
 * Threads: a model may be used by several threads at once. Any other handle belongs to one thread at a time, but for
 * dermis_source_stop(). Pointers that a handle gives out are valid until its next call, and until it is freed.
 */

#ifdef __cplusplus
extern "C" {
#endif

typedef enum dermis_status {
  DERMIS_OK = 0,
  DERMIS_FAILED = 1,    /* The work could not be done: a device that was unplugged, no memory. */
  DERMIS_BAD_INPUT = 2, /* A file, an argument or a device said something that cannot be used. */
  DERMIS_END = 3        /* A source has no further frame. */
} dermis_status;

/* Flags of dermis_force_frame.status; 0 if all is well. */
enum {
  DERMIS_FRAME_REJECTED = 1,             /* Wrong shape, not a number, absurd supply, time going backwards. */
  DERMIS_FRAME_SATURATED = 2,            /* At least one taxel is saturated. */
  DERMIS_FRAME_ABOVE_RANGE = 4,          /* At least one taxel is beyond its heaviest calibrated load. */
  DERMIS_FRAME_DEAD_TAXELS = 8,          /* The array has dead taxels. */
  DERMIS_FRAME_TEMPERATURE_UNKNOWN = 16, /* The mean of the calibration is taken. */
  DERMIS_FRAME_TEMPERATURE_CLAMPED = 32, /* Outside the calibrated temperatures. */
  DERMIS_FRAME_NOT_CONVERGED = 64,       /* The crosstalk inversion did not reach its tolerance. */
  DERMIS_FRAME_LINE_FAULT = 128,         /* A line or taxel is faulty and masked. */
  DERMIS_FRAME_SUPPLY_CLAMPED = 256,     /* Outside the supplies of the calibration: the nearest is used. */
  DERMIS_FRAME_SUPPLY_IMPLAUSIBLE = 512, /* More than 20 % from nominal, too: that is used. */
  DERMIS_FRAME_DOUBTFUL = 1024           /* A reading jumped, and may be no press: the sigma of its force says so. */
};

/* Values of dermis_force_frame.taxels. */
enum {
  DERMIS_TAXEL_OK = 0,
  DERMIS_TAXEL_SATURATED = 1,   /* The force is at least the one given. */
  DERMIS_TAXEL_ABOVE_RANGE = 2, /* Extrapolated. */
  DERMIS_TAXEL_DEAD = 3,        /* No force (NaN), as with the following. */
  DERMIS_TAXEL_LINE_FAULT = 4,
  DERMIS_TAXEL_INVALID = 5
};

/* The version of the library that runs, such as "1.2.3". */
const char* dermis_version(void);

/* One line that names the place and the mend: of the last call of this thread that did not return DERMIS_OK or
 * DERMIS_END. Valid until the next such call. "" before the first. */
const char* dermis_last_error(void);

/* ---- models ---- */

typedef struct dermis_model dermis_model;

/* A model file of `dermis calibrate`. */
dermis_status dermis_model_read(const char* path, dermis_model** model);
void dermis_model_free(dermis_model* model);

size_t dermis_model_rows(const dermis_model* model);
size_t dermis_model_cols(const dermis_model* model);
const char* dermis_model_name(const dermis_model* model);

/* ---- frames ---- */

/* A frame as the device sent it. */
typedef struct dermis_raw_frame {
  int64_t time_ns;            /* Time of the host or of the device; it must not go back. */
  double temperature_celsius; /* NaN: not known. */
  double supply_v;            /* > 0; NaN: not known. */
  const float* counts;        /* [rows, cols], ADC readings */
  size_t count;               /* rows * cols */
} dermis_raw_frame;

/* Forces for the robot. */
typedef struct dermis_force_frame {
  int64_t time_ns;
  uint32_t status;              /* DERMIS_FRAME_... */
  const float* newtons;         /* [rows, cols], >= 0; NaN where `taxels` says that there is no force */
  const float* sigma_newtons;   /* [rows, cols], standard deviation of each; infinite for a lower bound */
  const float* signal_to_noise; /* [rows, cols], what shows beyond an unloaded taxel, over its noise */
  const uint8_t* taxels;        /* [rows, cols], DERMIS_TAXEL_... */
  size_t count;                 /* rows * cols */
} dermis_force_frame;

/* ---- pipelines ---- */

typedef struct dermis_pipeline dermis_pipeline;

/* The model may be freed before the pipeline. */
dermis_status dermis_pipeline_create(const dermis_model* model, dermis_pipeline** pipeline);
void dermis_pipeline_free(dermis_pipeline* pipeline);

/* Counts to newtons. Errors of a frame are in its status; only NULL pointers are an error. Allocates nothing after
 * the first frame. */
dermis_status dermis_pipeline_process(dermis_pipeline* pipeline, const dermis_raw_frame* raw,
                                      dermis_force_frame* force);

/* A sum of forces. */
typedef struct dermis_total {
  double newtons;       /* NaN where all taxels are left out; noise takes it below 0 where nothing presses */
  double sigma_newtons; /* Its standard deviation, with the errors that taxels share; infinite for a lower bound */
  size_t left_out;      /* Taxels without a force, which are not in the sum */
} dermis_total;

/* The force of the last frame on the taxels whose byte in `mask` [rows, cols] is not 0, or on all where it is NULL. Use
 * it in place of a sum of newtons. These are cut at zero, so noise does not cancel in their sum. `count`: rows * cols.
 */
dermis_status dermis_pipeline_total(const dermis_pipeline* pipeline, const uint8_t* mask, size_t count,
                                    dermis_total* total);

/* Takes the next second, at least 10 frames, for unloaded. Refused where a load stands on the array: zero is as it was,
 * and dermis_pipeline_tare_refused() says why. */
dermis_status dermis_pipeline_tare(dermis_pipeline* pipeline);

/* The same, whatever stands there: it reads 0 N from then on. */
dermis_status dermis_pipeline_tare_force(dermis_pipeline* pipeline);

/* For a refused tare: "r3c4 to r5c6 read 48 N: take it off and tare again". Otherwise "", also while a tare goes on. */
const char* dermis_pipeline_tare_refused(dermis_pipeline* pipeline);

/* Back to the zero before the last tare. */
dermis_status dermis_pipeline_undo_tare(dermis_pipeline* pipeline);

/* Follows the offsets of idle taxels slowly, or stops to; off at first. */
dermis_status dermis_pipeline_follow_drift(dermis_pipeline* pipeline, int follow);

/* ---- contacts ---- */

typedef struct dermis_tracker dermis_tracker;

typedef enum dermis_contact_phase { DERMIS_ONSET = 0, DERMIS_HELD = 1, DERMIS_RELEASE = 2 } dermis_contact_phase;

/* x along the columns, y along the rows, from the centre of r0c0. */
typedef struct dermis_contact {
  uint32_t id;    /* From 1 on; the same from onset to release. */
  uint32_t phase; /* dermis_contact_phase */
  int64_t onset_ns;
  double x_m, y_m;
  double sigma_x_m, sigma_y_m;
  double velocity_x_m_s, velocity_y_m_s;
  double force_n, sigma_force_n;
  double area_m2;
  double peak_pressure_pa;
  uint32_t taxels;
} dermis_contact;

dermis_status dermis_tracker_create(const dermis_model* model, dermis_tracker** tracker);
void dermis_tracker_free(dermis_tracker* tracker);

/* The contacts of the frame that `pipeline` processed last. */
dermis_status dermis_tracker_process(dermis_tracker* tracker, const dermis_pipeline* pipeline,
                                     const dermis_contact** contacts, size_t* count);

/* ---- sources ---- */

typedef struct dermis_source dermis_source;

/* A device or the simulator by its URI (docs/devices.md), or a file of frames by its path. `model`: whose shape the
 * frames must have; NULL: any. */
dermis_status dermis_source_open(const char* uri, const dermis_model* model, dermis_source** source);
void dermis_source_free(dermis_source* source);

/* The next frame; waits for it. DERMIS_END: there is none. */
dermis_status dermis_source_next(dermis_source* source, dermis_raw_frame* raw);

/* Ends a wait for a live source within 100 ms. From any thread, and from a signal handler. */
void dermis_source_stop(dermis_source* source);

#ifdef __cplusplus
}
#endif

#endif /* DERMIS_H */
