/* SPDX-License-Identifier: Apache-2.0 */
/* SPDX-FileCopyrightText: 2026 The dermis authors */
/* A subscriber of another vendor, Cyclone DDS, with types of its own IDL compiler.

     cyclone_reader DOMAIN SECONDS reliable|best_effort TOPIC=TYPE...

   prints each message as a line of JSON, and "ready" when every topic has a publisher. With SECONDS below 0 it counts for
   -SECONDS from the first message on instead, and prints for each topic what came, what was lost and the latencies from
   the writing of a message to its reading. Its participant is set by CYCLONEDDS_URI. */
#include <dds/dds.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ros.h"

struct type {
  const char* name;
  const dds_topic_descriptor_t* descriptor;
  void (*print)(const void* value);
};

static void print_text(const char* text) {
  putchar('"');
  for (; *text; ++text) {
    if (*text == '"' || *text == '\\') putchar('\\');
    putchar(*text);
  }
  putchar('"');
}
static void print_number(double value) {
  if (isnan(value)) {
    fputs("NaN", stdout);
  } else if (isinf(value)) {
    fputs(value < 0 ? "-Infinity" : "Infinity", stdout);
  } else {
    printf("%.17g", value);
  }
}
static void print_bool(bool value) { fputs(value ? "true" : "false", stdout); }
static void print_integer(int64_t value) { printf("%" PRId64, value); }
static void print_unsigned(uint64_t value) { printf("%" PRIu64, value); }
static void print_bytes(const uint8_t* bytes, uint32_t count) {
  putchar('"');
  for (uint32_t i = 0; i < count; ++i) printf("%02x", bytes[i]);
  putchar('"');
}

#include "print_ros.h"

enum { most_topics = 64, most_messages = 2000000, most_at_once = 64 };
static struct {
  const char* name;
  const struct type* type;
  dds_entity_t reader;
  int64_t* latencies;
  size_t count;
} topics[most_topics];

static void fail(const char* what) {
  fprintf(stderr, "cyclone_reader: %s\n", what);
  exit(1);
}

static void open_topic(dds_entity_t participant, const dds_qos_t* qos, char* argument, size_t k) {
  char* const separator = strchr(argument, '=');
  dds_entity_t topic = 0;
  if (separator == NULL || k >= most_topics) fail("usage: cyclone_reader DOMAIN SECONDS RELIABILITY TOPIC=TYPE...");
  *separator = '\0';
  topics[k].name = argument;
  for (size_t i = 0; i < sizeof types / sizeof *types; ++i) {
    if (strcmp(types[i].name, separator + 1) == 0) topics[k].type = &types[i];
  }
  if (topics[k].type == NULL) fail("no such type");
  topic = dds_create_topic(participant, topics[k].type->descriptor, argument, NULL, NULL);
  topics[k].reader = dds_create_reader(participant, topic, qos, NULL);
  topics[k].latencies = malloc(most_messages * sizeof(int64_t));
  if (topic < 0 || topics[k].reader < 0 || topics[k].latencies == NULL) fail("cannot subscribe");
}

static dds_qos_t* reader_qos(const char* reliability, const char* topic) {
  dds_qos_t* const qos = dds_create_qos();
  const bool is_reliable = strcmp(reliability, "reliable") == 0;
  dds_qset_reliability(qos, is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, DDS_SECS(1));
  dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
  if (strstr(topic, "_static") != NULL) dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_data_representation(qos, 1, (dds_data_representation_id_t[]){DDS_DATA_REPRESENTATION_XCDR1});
  return qos;
}

static void take(size_t k, bool counts) {
  void* samples[most_at_once] = {NULL};
  dds_sample_info_t infos[most_at_once];
  dds_return_t taken = 0;
  while ((taken = dds_take(topics[k].reader, samples, infos, most_at_once, most_at_once)) > 0) {
    for (dds_return_t i = 0; i < taken; ++i) {
      if (!infos[i].valid_data) continue;
      if (topics[k].count < most_messages) topics[k].latencies[topics[k].count++] = dds_time() - infos[i].source_timestamp;
      if (counts) continue;
      printf("{\"topic\":\"%s\",\"message\":", topics[k].name);
      topics[k].type->print(samples[i]);
      fputs("}\n", stdout);
    }
    dds_return_loan(topics[k].reader, samples, taken);
  }
  if (!counts) fflush(stdout);
}

static int by_size(const void* a, const void* b) {
  const int64_t x = *(const int64_t*)a;
  const int64_t y = *(const int64_t*)b;
  return (x > y) - (x < y);
}

static void print_counts(size_t k) {
  dds_sample_lost_status_t lost = {0};
  const size_t count = topics[k].count;
  int64_t* const latencies = topics[k].latencies;
  dds_get_sample_lost_status(topics[k].reader, &lost);
  qsort(latencies, count, sizeof *latencies, by_size);
  printf("{\"topic\":\"%s\",\"messages\":%zu,\"lost\":%u", topics[k].name, count, lost.total_count);
  if (count > 0) {
    const size_t middle = count / 2;
    const size_t one_in_hundred = count / 100;
    printf(",\"p50_ms\":%.3f,\"p99_ms\":%.3f,\"worst_ms\":%.3f", (double)latencies[middle] * 1e-6,
           (double)latencies[count - 1 - one_in_hundred] * 1e-6, (double)latencies[count - 1] * 1e-6);
  }
  fputs("}\n", stdout);
}

int main(int argc, char** argv) {
  if (argc < 5) fail("usage: cyclone_reader DOMAIN SECONDS RELIABILITY TOPIC=TYPE...");
  const dds_entity_t participant = dds_create_participant((dds_domainid_t)atoi(argv[1]), NULL, NULL);
  const double seconds = atof(argv[2]);
  const bool counts = seconds < 0;
  const size_t count = (size_t)argc - 4;
  const dds_entity_t waitset = dds_create_waitset(participant);
  if (participant < 0 || waitset < 0) fail("cannot take part in the domain");
  for (size_t k = 0; k < count; ++k) {
    dds_qos_t* const qos = reader_qos(argv[3], argv[4 + k]);
    open_topic(participant, qos, argv[4 + k], k);
    dds_delete_qos(qos);
    dds_set_status_mask(topics[k].reader, DDS_DATA_AVAILABLE_STATUS | DDS_SUBSCRIPTION_MATCHED_STATUS);
    dds_waitset_attach(waitset, topics[k].reader, (dds_attach_t)k);
  }
  bool is_ready = false;
  dds_time_t end = dds_time() + DDS_SECS(60);
  while (dds_time() < end) {
    dds_attach_t which[most_topics];
    size_t matched = 0;
    dds_waitset_wait(waitset, which, most_topics, DDS_MSECS(20));
    for (size_t k = 0; k < count; ++k) {
      dds_subscription_matched_status_t status;
      uint32_t changed = 0;
      dds_get_subscription_matched_status(topics[k].reader, &status);
      dds_take_status(topics[k].reader, &changed, DDS_DATA_AVAILABLE_STATUS);
      matched += status.current_count > 0;
      take(k, counts);
    }
    if (!is_ready && matched == count) {
      is_ready = true;
      end = dds_time() + (dds_duration_t)(fabs(seconds) * 1e9);
      puts("ready");
      fflush(stdout);
    }
  }
  if (!is_ready) fail("no publisher for every topic within 60 s");
  for (size_t k = 0; counts && k < count; ++k) print_counts(k);
  dds_delete(participant);
  return 0;
}
