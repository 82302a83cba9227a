/* SPDX-License-Identifier: Apache-2.0 */
/* SPDX-FileCopyrightText: 2026 The dermis authors */
/* Hands that publish their touch, by another vendor's DDS, with types of its own IDL compiler.

     cyclone_hand DOMAIN READERS RATE SECONDS reliable|best_effort TOPIC=hand_state|inspire_touch|float_array...

   waits for so many readers of every topic and prints "ready". Then it publishes RATE messages of each a second, and
   "sent N" at the end. Its participant is set by CYCLONEDDS_URI. Message n of topic k (both from 0 on) holds

     hand_state     module m, taxel t: pressure 100000 + 1000 k + 100 m + t + 16 (n mod 5000), but 30000 in taxel 11 of
   module 8; temperature 20 + k + m/2 + t/16 + (n mod 64)/8 inspire_touch  taxel t of all 1062: (1000 k + 7 t + 13 n)
   mod 4096 float_array    of 4x5, taxel t: n + t/4 */
#include <dds/dds.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "hands.h"

typedef unitree_hg_msg_dds__HandState_ HandState;
typedef inspire_inspire_hand_touch InspireTouch;
typedef std_msgs_msg_dds__Float32MultiArray_ FloatArray;

enum { motors = 7, modules = 9, taxels = 12, most_topics = 8, inspire_taxels = 1062, regions = 17, rows = 4, cols = 5 };

static struct {
  const char* type;
  dds_entity_t writer;
  void* message;
} topics[most_topics];

static void fail(const char* what) {
  fprintf(stderr, "cyclone_hand: %s\n", what);
  exit(1);
}

static void* make(size_t count, size_t size) {
  void* const made = calloc(count, size);
  if (made == NULL) fail("no memory");
  return made;
}

static void* make_hand_state(void) {
  HandState* const hand = make(1, sizeof *hand);
  hand->motor_state._length = hand->motor_state._maximum = motors;
  hand->motor_state._buffer = make(motors, sizeof *hand->motor_state._buffer);
  hand->press_sensor_state._length = hand->press_sensor_state._maximum = modules;
  hand->press_sensor_state._buffer = make(modules, sizeof *hand->press_sensor_state._buffer);
  return hand;
}

static void fill_hand_state(HandState* hand, uint32_t k, uint32_t n) {
  for (uint32_t j = 0; j < motors; ++j) {
    hand->motor_state._buffer[j].mode = (uint8_t)j;
    hand->motor_state._buffer[j].q = (float)n;
  }
  for (uint32_t m = 0; m < modules; ++m) {
    for (uint32_t t = 0; t < taxels; ++t) {
      const bool is_absent = m == 8 && t == 11;
      hand->press_sensor_state._buffer[m].pressure[t] =
          is_absent ? 30000.0F : 100000.0F + (float)(1000 * k + 100 * m + t + 16 * (n % 5000));
      hand->press_sensor_state._buffer[m].temperature[t] =
          20.0F + (float)k + (float)m / 2.0F + (float)t / 16.0F + (float)(n % 64) / 8.0F;
    }
  }
}

/* The sequences of the message are alike, one behind the other. */
static void* make_inspire_touch(void) {
  static const uint32_t kSizes[regions] = {9, 96, 80, 9, 96, 80, 9, 96, 80, 9, 96, 80, 9, 96, 9, 96, 112};
  InspireTouch* const touch = make(1, sizeof *touch);
  int16_t* readings = make(inspire_taxels, sizeof *readings);
  for (size_t region = 0; region < regions; ++region) {
    dds_sequence_t* const sequence = (dds_sequence_t*)touch + region;
    sequence->_length = sequence->_maximum = kSizes[region];
    sequence->_buffer = (uint8_t*)readings;
    readings += kSizes[region];
  }
  return touch;
}

static void fill_inspire_touch(InspireTouch* touch, uint32_t k, uint32_t n) {
  for (uint32_t t = 0; t < inspire_taxels; ++t) {
    touch->fingerone_tip_touch._buffer[t] = (int16_t)((1000 * k + 7 * t + 13 * n) % 4096);
  }
}

static void* make_float_array(void) {
  FloatArray* const array = make(1, sizeof *array);
  array->layout.dim._length = array->layout.dim._maximum = 2;
  array->layout.dim._buffer = make(2, sizeof *array->layout.dim._buffer);
  array->layout.dim._buffer[0].label = "rows";
  array->layout.dim._buffer[0].size = rows;
  array->layout.dim._buffer[0].stride = rows * cols;
  array->layout.dim._buffer[1].label = "cols";
  array->layout.dim._buffer[1].size = cols;
  array->layout.dim._buffer[1].stride = cols;
  array->data._length = array->data._maximum = rows * cols;
  array->data._buffer = make((size_t)rows * cols, sizeof(float));
  return array;
}

static void fill(size_t k, uint32_t n) {
  if (strcmp(topics[k].type, "hand_state") == 0) {
    fill_hand_state(topics[k].message, (uint32_t)k, n);
  } else if (strcmp(topics[k].type, "inspire_touch") == 0) {
    fill_inspire_touch(topics[k].message, (uint32_t)k, n);
  } else {
    FloatArray* const array = topics[k].message;
    for (uint32_t t = 0; t < rows * cols; ++t) array->data._buffer[t] = (float)n + (float)t / 4.0F;
  }
}

static void open_topic(dds_entity_t participant, const dds_qos_t* qos, char* argument, size_t k) {
  char* const separator = strchr(argument, '=');
  if (separator == NULL || k >= most_topics)
    fail("usage: cyclone_hand DOMAIN READERS RATE SECONDS RELIABILITY TOPIC=TYPE...");
  *separator = '\0';
  topics[k].type = separator + 1;
  const dds_topic_descriptor_t* descriptor = &std_msgs_msg_dds__Float32MultiArray__desc;
  if (strcmp(topics[k].type, "hand_state") == 0) {
    descriptor = &unitree_hg_msg_dds__HandState__desc;
    topics[k].message = make_hand_state();
  } else if (strcmp(topics[k].type, "inspire_touch") == 0) {
    descriptor = &inspire_inspire_hand_touch_desc;
    topics[k].message = make_inspire_touch();
  } else {
    topics[k].message = make_float_array();
  }
  const dds_entity_t topic = dds_create_topic(participant, descriptor, argument, NULL, NULL);
  topics[k].writer = dds_create_writer(participant, topic, qos, NULL);
  if (topic < 0 || topics[k].writer < 0) fail("cannot publish");
}

static void wait_for_readers(size_t count, uint32_t readers) {
  for (size_t k = 0; k < count; ++k) {
    dds_publication_matched_status_t matched = {0};
    while (matched.current_count < readers) {
      usleep(10000);
      dds_get_publication_matched_status(topics[k].writer, &matched);
    }
  }
  usleep(500000); /* that readers know the writers, too */
}

int main(int argc, char** argv) {
  if (argc < 7) fail("usage: cyclone_hand DOMAIN READERS RATE SECONDS RELIABILITY TOPIC=TYPE...");
  const dds_entity_t participant = dds_create_participant((dds_domainid_t)atoi(argv[1]), NULL, NULL);
  if (participant < 0) fail("cannot take part in the domain");
  const double rate = atof(argv[3]);
  const uint32_t messages = (uint32_t)(rate * atof(argv[4]));
  const bool is_reliable = strcmp(argv[5], "reliable") == 0;
  const size_t count = (size_t)argc - 6;
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_reliability(qos, is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, DDS_SECS(10));
  for (size_t k = 0; k < count; ++k) open_topic(participant, qos, argv[6 + k], k);
  wait_for_readers(count, (uint32_t)atoi(argv[2]));
  puts("ready");
  fflush(stdout);
  struct timespec due;
  clock_gettime(CLOCK_MONOTONIC, &due);
  for (uint32_t n = 0; n < messages; ++n) {
    for (size_t k = 0; k < count; ++k) {
      fill(k, n);
      if (dds_write(topics[k].writer, topics[k].message) != DDS_RETCODE_OK) fail("cannot write");
    }
    due.tv_nsec += (long)(1e9 / rate);
    while (due.tv_nsec >= 1000000000) {
      due.tv_nsec -= 1000000000;
      ++due.tv_sec;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL);
  }
  for (size_t k = 0; k < count; ++k) dds_wait_for_acks(topics[k].writer, DDS_SECS(10));
  printf("sent %u\n", messages);
  fflush(stdout);
  usleep(500000);
  dds_delete(participant);
  return 0;
}
