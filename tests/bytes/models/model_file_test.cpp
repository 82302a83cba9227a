// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/models/model_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "dermis/bytes/files/safetensors.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/hand_made_model.hpp"
#include "support/random_networks.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::models {
namespace {

using touch::pipeline::Model;

using support::TemporaryFolder;

touch::fusion::LookUpTables make_baseline(std::size_t taxels, const char* name, touch::fusion::LookUpSignal signal) {
  touch::fusion::LookUpTables tables;
  tables.name = name;
  tables.signal = signal;
  tables.reference_celsius = 23.5;
  tables.knots = 3;
  for (std::size_t k = 0; k < taxels; ++k) {
    const auto at = static_cast<double>(k);
    tables.knot_signal.insert(tables.knot_signal.end(), {0.1 * at, 0.1 * at + 0.25, 0.1 * at + 1.0 / 3.0});
    tables.knot_newtons.insert(tables.knot_newtons.end(), {0.0, 1.0 + at, 1e3 / 7.0});
    tables.temperature_coefficient.push_back(-1e-3 * at);
  }
  return tables;
}

/// Every field differs from its default.
Model make_model() {
  Model model = support::hand_made_model(2, 3);
  model.array.name = "chest \"left\"";
  model.array.row_pitch_m = 0.0075;
  model.array.col_pitch_m = 0.0125;
  model.array.taxel_area_m2 = 3.848e-5;
  model.array.readout.drive_ohm = {20.0, 21.5};
  model.array.readout.drive_error_ohm = {0.5, 1.0 / 3.0};
  model.array.readout.drive_error_correlation = 0.25;
  model.array.readout.load_ohm = {200.0, 201.25, 1.0 / 3.0};
  model.networks.gain_errors = {{0.1F, 0.0F, 0.01F, 0.2F, 1.0F / 3.0F, 0.05F}, 3, 0.25, 1.0 / 3.0, 0.125};
  model.array.readout.adc_bits = 14;
  model.array.readout.adc_noise_counts = 1.0 / 3.0;
  model.array.readout.supply_noise = 1.0 / 700.0;
  model.array.readout.adc_reference_v = 3.3;
  model.array.readout.supply_v = 5.1;
  model.array.readout.pressure_raises_reading = false;
  model.networks = support::random_networks(6, 3, 4, 77);
  model.networks.temperature_gap_celsius = {12.0, 100.0 / 3.0};
  model.networks.sigma_knots_newtons = {0.3F, 77.0F};
  model.networks.end_bends = {0.25F, 1.0F / 3.0F};
  model.networks.heaviest_newtons[2] = std::numeric_limits<float>::infinity();
  model.networks.dead[5] = 1;
  model.networks.tables = {{1, 4}, 2, {1e-4F, 3e-4F, 2e-4F, 1e-3F}, {1.0F, 7.0F, 0.5F, 9.0F}, {0.01F, -0.002F}};
  model.memory = touch::fusion::MemoryLaw{{0.1F, 0.0F, 0.05F, 0.2F}, {0.01F, 0.03F, 0.02F}};
  model.supply = touch::preprocessing::SupplyRange{4.6, 5.4};
  model.baselines = {make_baseline(6, "raw look-up", touch::fusion::LookUpSignal::reading),
                     make_baseline(6, "look-up", touch::fusion::LookUpSignal::conductance)};
  model.provenance = {{"frames", "120"}, {"note", "two\nlines, \"quotes\" and \xC2\xB5"}, {"empty", ""}};
  return model;
}

void expect_equal(const Model& a, const Model& b) {
  EXPECT_EQ(a.array.name, b.array.name);
  EXPECT_EQ(a.array.rows, b.array.rows);
  EXPECT_EQ(a.array.cols, b.array.cols);
  EXPECT_DOUBLE_EQ(a.array.row_pitch_m, b.array.row_pitch_m);
  EXPECT_DOUBLE_EQ(a.array.col_pitch_m, b.array.col_pitch_m);
  ASSERT_EQ(a.array.taxel_area_m2.has_value(), b.array.taxel_area_m2.has_value());
  EXPECT_DOUBLE_EQ(a.array.taxel_area_m2.value_or(0.0), b.array.taxel_area_m2.value_or(0.0));
  EXPECT_EQ(a.array.readout.circuit, b.array.readout.circuit);
  EXPECT_EQ(a.array.readout.idle_rows, b.array.readout.idle_rows);
  EXPECT_EQ(a.array.readout.drive_ohm, b.array.readout.drive_ohm);
  EXPECT_EQ(a.array.readout.drive_error_ohm, b.array.readout.drive_error_ohm);
  EXPECT_EQ(a.array.readout.drive_error_correlation, b.array.readout.drive_error_correlation);
  EXPECT_EQ(a.array.readout.load_ohm, b.array.readout.load_ohm);
  EXPECT_EQ(a.array.readout.adc_bits, b.array.readout.adc_bits);
  EXPECT_EQ(a.array.readout.adc_noise_counts, b.array.readout.adc_noise_counts);
  EXPECT_EQ(a.array.readout.supply_noise, b.array.readout.supply_noise);
  EXPECT_EQ(a.array.readout.adc_reference_v, b.array.readout.adc_reference_v);
  EXPECT_EQ(a.array.readout.supply_v, b.array.readout.supply_v);
  EXPECT_EQ(a.array.readout.pressure_raises_reading, b.array.readout.pressure_raises_reading);

  EXPECT_EQ(a.networks.shape, b.networks.shape);
  EXPECT_EQ(a.networks.unloaded.temperature.centre_celsius, b.networks.unloaded.temperature.centre_celsius);
  EXPECT_EQ(a.networks.unloaded.temperature.half_span_celsius, b.networks.unloaded.temperature.half_span_celsius);
  EXPECT_EQ(a.networks.unloaded.offset_siemens, b.networks.unloaded.offset_siemens);
  EXPECT_EQ(a.networks.unloaded.per_celsius, b.networks.unloaded.per_celsius);
  EXPECT_EQ(a.networks.reference_siemens, b.networks.reference_siemens);
  EXPECT_EQ(a.networks.heaviest_siemens, b.networks.heaviest_siemens);
  EXPECT_EQ(a.networks.heaviest_newtons, b.networks.heaviest_newtons);
  EXPECT_EQ(a.networks.gain, b.networks.gain);
  EXPECT_EQ(a.networks.dead, b.networks.dead);
  EXPECT_EQ(a.networks.parameters, b.networks.parameters);
  EXPECT_EQ(a.networks.temperature_sigma_celsius, b.networks.temperature_sigma_celsius);
  EXPECT_EQ(a.networks.temperature_gap_celsius, b.networks.temperature_gap_celsius);
  EXPECT_EQ(a.networks.offset_sigma_siemens, b.networks.offset_sigma_siemens);
  EXPECT_EQ(a.networks.relative_sigma, b.networks.relative_sigma);
  EXPECT_EQ(a.networks.sigma_knots_newtons, b.networks.sigma_knots_newtons);
  EXPECT_EQ(a.networks.gain_errors, b.networks.gain_errors);
  EXPECT_EQ(a.networks.end_bends, b.networks.end_bends);
  EXPECT_EQ(a.networks.tables.taxels, b.networks.tables.taxels);
  EXPECT_EQ(a.networks.tables.knots, b.networks.tables.knots);
  EXPECT_EQ(a.networks.tables.siemens, b.networks.tables.siemens);
  EXPECT_EQ(a.networks.tables.newtons, b.networks.tables.newtons);
  EXPECT_EQ(a.networks.tables.per_celsius, b.networks.tables.per_celsius);

  ASSERT_EQ(a.baselines.size(), b.baselines.size());
  for (std::size_t k = 0; k < a.baselines.size(); ++k) {
    EXPECT_EQ(a.baselines[k].name, b.baselines[k].name);
    EXPECT_EQ(a.baselines[k].signal, b.baselines[k].signal);
    EXPECT_EQ(a.baselines[k].reference_celsius, b.baselines[k].reference_celsius);
    EXPECT_EQ(a.baselines[k].knots, b.baselines[k].knots);
    EXPECT_EQ(a.baselines[k].knot_signal, b.baselines[k].knot_signal);
    EXPECT_EQ(a.baselines[k].knot_newtons, b.baselines[k].knot_newtons);
    EXPECT_EQ(a.baselines[k].temperature_coefficient, b.baselines[k].temperature_coefficient);
  }
  EXPECT_EQ(a.memory, b.memory);
  EXPECT_EQ(a.supply, b.supply);
  EXPECT_EQ(a.provenance, b.provenance);
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// One line that names the file, and whose fault it is.
void expect_refused(const std::string& path, const std::string& mention = {}) {
  const auto model = read_model(path);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().kind, ErrorKind::bad_input);
  EXPECT_TRUE(model.error().message.starts_with(path + ":")) << model.error().message;
  EXPECT_EQ(model.error().message.find('\n'), std::string::npos) << model.error().message;
  EXPECT_NE(model.error().message.find(mention), std::string::npos) << model.error().message;
}

/// The file of make_model(), changed by `damage`.
void write_damaged(const std::string& path, const std::function<void(files::SafetensorsFile&)>& damage) {
  ASSERT_TRUE(write_model(path, make_model()));
  auto file = files::read_safetensors(path);
  ASSERT_TRUE(file);
  damage(*file);
  ASSERT_TRUE(files::write_safetensors(path, *file));
}

std::vector<std::string> tensor_names(const std::string& path) {
  std::vector<std::string> names;
  const auto file = files::read_safetensors(path);
  for (const auto& [name, tensor] : file->tensors) names.push_back(name);
  return names;
}

TEST(Model, what_is_written_is_read) {
  const TemporaryFolder folder;
  const Model model = make_model();
  ASSERT_TRUE(write_model(folder.file("m.safetensors"), model));
  const auto read = read_model(folder.file("m.safetensors"));
  ASSERT_TRUE(read) << read.error().message;
  expect_equal(*read, model);
}

TEST(Model, without_a_table_says_nothing_of_tables) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_model(folder.file("m.safetensors"), support::hand_made_model(2, 2)));
  for (const std::string& name : tensor_names(folder.file("m.safetensors"))) {
    EXPECT_FALSE(name.starts_with("tables")) << name;
  }
  EXPECT_EQ(bytes_of(folder.file("m.safetensors")).find("tables"), std::string::npos);
}

TEST(Model, without_memory_says_nothing_of_it) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_model(folder.file("m.safetensors"), support::hand_made_model(2, 2)));
  EXPECT_EQ(bytes_of(folder.file("m.safetensors")).find("memory"), std::string::npos);
  EXPECT_FALSE(read_model(folder.file("m.safetensors"))->memory);
}

TEST(Model, without_a_supply_says_nothing_of_it) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_model(folder.file("m.safetensors"), support::hand_made_model(2, 2)));
  EXPECT_EQ(bytes_of(folder.file("m.safetensors")).find("supply.range"), std::string::npos);
  EXPECT_FALSE(read_model(folder.file("m.safetensors"))->supply);
}

TEST(Model, a_supply_out_of_order_is_refused) {
  const TemporaryFolder folder;
  write_damaged(folder.file("m"), [&](auto& file) {
    file.tensors["supply.range_v"].values = std::vector<double>{5.4, 4.6};
  });
  expect_refused(folder.file("m"), "out of range");
  write_damaged(folder.file("m"), [&](auto& file) {
    file.tensors["supply.range_v"] = {{1}, std::vector<double>{5.4}};
  });
  expect_refused(folder.file("m"), "supply.range_v");
}

TEST(Model, a_file_in_which_bits_were_flipped_or_tensors_exchanged_is_refused) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_model(folder.file("whole"), make_model()));
  const std::string whole = bytes_of(folder.file("whole"));
  Random random(9);
  for (int flip = 0; flip < 300; ++flip) {
    std::string flipped = whole;
    char& byte = flipped[random.below(flipped.size())];
    byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1U << random.below(8)));
    write_bytes(folder.file("m"), flipped);
    expect_refused(folder.file("m"));
  }
  const std::string key = "\"checksum\":";
  std::string renamed = whole;
  renamed.replace(renamed.find(key), key.size(), "\"checksun\":");
  write_bytes(folder.file("m"), renamed);
  expect_refused(folder.file("m"), "is damaged: it has lost its checksum");
  write_damaged(folder.file("m"), [](auto& file) {
    std::swap(file.tensors["networks.reference_siemens"], file.tensors["networks.heaviest_siemens"]);
  });
  std::string exchanged = bytes_of(folder.file("m"));
  const auto checksum_in = [](std::string& bytes) { return std::span(bytes).subspan(bytes.find("fnv1a64:"), 24); };
  std::string original = whole;
  std::ranges::copy(checksum_in(original), checksum_in(exchanged).begin());
  write_bytes(folder.file("m"), exchanged);
  expect_refused(folder.file("m"), "is damaged: its checksum differs");
}

TEST(Model, of_before_there_were_checksums_is_read) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_model(folder.file("m"), make_model()));
  std::string old = bytes_of(folder.file("m"));
  const std::size_t key = old.find("\"checksum\":");
  const std::size_t size = std::string(R"("checksum":"fnv1a64:0123456789abcdef",)").size();
  old.replace(key, size, std::string(size, ' '));
  old.replace(old.find("dermis model 3"), 14, "dermis model 2");
  write_bytes(folder.file("m"), old);
  const auto read = read_model(folder.file("m"));
  ASSERT_TRUE(read) << read.error().message;
  expect_equal(*read, make_model());
  EXPECT_TRUE(files::checksum_note(folder.file("m"), kModelFormat));
}

TEST(Model, memory_that_cannot_be_undone_is_refused) {
  const TemporaryFolder folder;
  write_damaged(folder.file("m"), [&](auto& file) {
    file.tensors["memory.creep"].values = std::vector<float>{0.3F, 0.3F, 0.3F, 0.1F};
  });
  expect_refused(folder.file("m"), "out of range");
}

TEST(Model, every_circuit_survives_the_file) {
  const TemporaryFolder folder;
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance, Circuit::none}) {
    for (const IdleRows idle_rows : {IdleRows::grounded, IdleRows::floating}) {
      Model model = support::hand_made_model(3, 2);
      model.array.readout.circuit = circuit;
      model.array.readout.idle_rows = idle_rows;
      if (circuit == Circuit::none) {
        model.array.readout.drive_ohm.clear();
        model.array.readout.load_ohm.clear();
      }
      ASSERT_TRUE(write_model(folder.file("m.safetensors"), model));
      const auto read = read_model(folder.file("m.safetensors"));
      ASSERT_TRUE(read) << read.error().message;
      expect_equal(*read, model);
    }
  }
}

TEST(Model, the_same_model_gives_the_same_bytes) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_model(folder.file("a"), make_model()));
  ASSERT_TRUE(write_model(folder.file("b"), make_model()));
  EXPECT_EQ(bytes_of(folder.file("a")), bytes_of(folder.file("b")));
  const auto read = read_model(folder.file("a"));
  ASSERT_TRUE(read);
  ASSERT_TRUE(write_model(folder.file("c"), *read));
  EXPECT_EQ(bytes_of(folder.file("a")), bytes_of(folder.file("c")));
}

TEST(Model, a_file_cut_anywhere_is_refused) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_model(folder.file("whole"), make_model()));
  const std::string bytes = bytes_of(folder.file("whole"));
  ASSERT_GT(bytes.size(), 2000U);
  for (std::size_t size = 0; size < bytes.size(); size += 97) {
    SCOPED_TRACE(testing::Message() << size << " of " << bytes.size() << " bytes");
    write_bytes(folder.file("cut"), bytes.substr(0, size));
    expect_refused(folder.file("cut"));
  }
  write_bytes(folder.file("cut"), bytes.substr(0, bytes.size() - 1));
  expect_refused(folder.file("cut"));
}

TEST(Model, a_file_with_a_flipped_byte_is_consistent_or_refused) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_model(folder.file("whole"), make_model()));
  const std::string bytes = bytes_of(folder.file("whole"));
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    std::string flipped = bytes;
    flipped[random.below(bytes.size())] = static_cast<char>(random.below(256));
    write_bytes(folder.file("flipped"), flipped);
    const auto model = read_model(folder.file("flipped"));
    if (model) {
      EXPECT_TRUE(model->networks.is_consistent());
      EXPECT_EQ(model->networks.taxel_count(), model->array.taxel_count());
    } else {
      expect_refused(folder.file("flipped"));
    }
  }
}

TEST(Model, missing_file_is_refused) {
  const TemporaryFolder folder;
  const auto model = read_model(folder.file("nowhere"));
  ASSERT_FALSE(model);
  EXPECT_NE(model.error().message.find(folder.file("nowhere")), std::string::npos);
  EXPECT_EQ(model.error().message.find('\n'), std::string::npos);
}

TEST(Model, safetensors_of_another_kind_are_refused_with_the_mend) {
  const TemporaryFolder folder;
  for (const char* format : {"", "pt", "dermis model 4"}) {
    write_damaged(folder.file("m"), [&](auto& file) { file.metadata["format"] = format; });
    expect_refused(folder.file("m"), "a calibration writes one");
  }
  write_damaged(folder.file("m"), [](auto& file) { file.metadata.erase("format"); });
  expect_refused(folder.file("m"), "a calibration writes one");
}

TEST(Model, the_format_that_did_not_know_its_uncertainty_is_refused_with_the_mend) {
  const TemporaryFolder folder;
  write_damaged(folder.file("m"), [](auto& file) { file.metadata["format"] = "dermis model 1"; });
  expect_refused(folder.file("m"), "is of an older dermis that did not know how sure its forces are");
  expect_refused(folder.file("m"), "calibrate again");
}

TEST(Model, every_tensor_must_be_there) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_model(folder.file("m"), make_model()));
  const auto names = tensor_names(folder.file("m"));
  EXPECT_EQ(names.size(), 21U + 2U * 4U);
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    write_damaged(folder.file("m"), [&](auto& file) { file.tensors.erase(name); });
    expect_refused(folder.file("m"), name);
  }
}

TEST(Model, every_tensor_must_have_its_shape_and_type) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_model(folder.file("m"), make_model()));
  for (const std::string& name : tensor_names(folder.file("m"))) {
    SCOPED_TRACE(name);
    write_damaged(folder.file("m"), [&](auto& file) {
      files::Tensor& tensor = file.tensors[name];
      std::visit([](auto& values) { values.pop_back(); }, tensor.values);
      tensor.shape = {std::visit([](auto& values) { return values.size(); }, tensor.values)};
    });
    expect_refused(folder.file("m"), name);
    write_damaged(folder.file("m"), [&](auto& file) { file.tensors[name].shape.push_back(1); });
    expect_refused(folder.file("m"), name);
    write_damaged(folder.file("m"), [&](auto& file) {
      files::Tensor& tensor = file.tensors[name];
      const std::size_t size = std::visit([](auto& values) { return values.size(); }, tensor.values);
      const bool are_int64 = std::holds_alternative<std::vector<std::int64_t>>(tensor.values);
      tensor.values = std::vector<std::int64_t>(size, 1);
      if (are_int64) tensor.values = std::vector<float>(size, 1.0F);
    });
    expect_refused(folder.file("m"), name);
  }
}

TEST(Model, tables_of_taxels_that_are_none_are_refused) {
  const TemporaryFolder folder;
  using Taxels = std::vector<std::int64_t>;
  constexpr std::int64_t kTwoTo32 = std::int64_t{1} << 32;
  for (const Taxels& taxels : {Taxels{-1, 4}, Taxels{1, 6}, Taxels{1, kTwoTo32 + 4}, Taxels{-kTwoTo32 + 1, 4}}) {
    SCOPED_TRACE(testing::Message() << taxels.front() << " and " << taxels.back());
    write_damaged(folder.file("m"), [&](auto& file) { file.tensors["tables.taxels"].values = taxels; });
    expect_refused(folder.file("m"), "out of range");
  }
}

TEST(Model, values_that_are_not_numbers_are_refused) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_model(folder.file("m"), make_model()));
  for (const std::string& name : tensor_names(folder.file("m"))) {
    if (name == "networks.dead") continue;
    SCOPED_TRACE(name);
    write_damaged(folder.file("m"), [&](auto& file) {
      std::visit(
          [](auto& values) {
            using Value = typename std::decay_t<decltype(values)>::value_type;
            values.back() = std::numeric_limits<Value>::quiet_NaN();
          },
          file.tensors[name].values);
    });
    expect_refused(folder.file("m"), "out of range");
  }
}

TEST(Model, an_array_of_another_size_or_none_is_refused) {
  const TemporaryFolder folder;
  write_damaged(folder.file("m"), [](auto& file) { file.metadata.erase("array"); });
  expect_refused(folder.file("m"));
  write_damaged(folder.file("m"), [](auto& file) { file.metadata["array"] = "rows = ["; });
  expect_refused(folder.file("m"));
  write_damaged(folder.file("m"), [](auto& file) {
    std::string& text = file.metadata["array"];
    const auto place = text.find("rows = 2");
    ASSERT_NE(place, std::string::npos) << text;
    text.replace(place, 8, "rows = 3");
  });
  expect_refused(folder.file("m"));
}

TEST(Model, another_network_shape_than_the_parameters_have_is_refused) {
  const TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::string>> changes = {
      {"networks.hidden", "3"}, {"networks.hidden", "-1"},       {"networks.hidden", "many"},
      {"networks.inputs", "2"}, {"networks.inputs", "0"},        {"networks.hidden", "9223372036854775808"},
      {"networks.inputs", ""},  {"baseline.0.knots", "1000000"}, {"baseline.1.knots", "0"}};
  for (const auto& [key, text] : changes) {
    SCOPED_TRACE(testing::Message() << key << " = \"" << text << "\"");
    write_damaged(folder.file("m"), [&](auto& file) { file.metadata[key] = text; });
    expect_refused(folder.file("m"));
  }
}

TEST(Model, more_baselines_than_can_be_read_are_refused) {
  const TemporaryFolder folder;
  Model model = make_model();
  model.baselines.assign(17, make_baseline(6, "look-up", touch::fusion::LookUpSignal::reading));
  ASSERT_TRUE(write_model(folder.file("m"), model));
  expect_refused(folder.file("m"), "17 baselines");
}

TEST(Model, a_folder_that_is_not_there_cannot_be_written_to) {
  const TemporaryFolder folder;
  const auto written = write_model(folder.file("no/such/folder/m"), make_model());
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message.find('\n'), std::string::npos);
}

TEST(Model, is_not_written_from_a_model_that_could_not_be_read_back) {
  Model model = support::hand_made_model(2, 2);
  model.networks.gain[1] = -1.0F;
  const TemporaryFolder folder;
  const std::string path = folder.file("model.safetensors");
  const Status written = write_model(path, model);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message, "cannot write '" + path + "': the model holds values out of range");
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(Model, keeps_the_learned_positions_of_a_strip) {
  const TemporaryFolder folder;
  Model model = support::hand_made_model(1, 3);
  model.strip = touch::contacts::StripTable{{0.001, 0.012, 0.019}, {0.0, 1.0 / 300.0, 0.02}, 1.0 / 7000.0};
  ASSERT_TRUE(write_model(folder.file("m.st"), model));
  const Result<Model> read = read_model(folder.file("m.st"));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_TRUE(read->strip);
  EXPECT_EQ(read->strip->centre_m, model.strip->centre_m);
  EXPECT_EQ(read->strip->position_m, model.strip->position_m);
  EXPECT_EQ(read->strip->sigma_m, model.strip->sigma_m);
  model.strip->centre_m[1] = 0.0;
  EXPECT_FALSE(write_model(folder.file("n.st"), model));
}

}  // namespace
}  // namespace dermis::bytes::models
