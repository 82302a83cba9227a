// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// How somebody lies on a mattress: learns four postures from eleven people and recognises those of the twelfth.
// Usage: 06_learn_postures FOLDER, with frames.npy, arrays.csv and labels.csv (docs/recognition.md).
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "dermis/learn/recognition/dataset.hpp"
#include "dermis/learn/recognition/learning.hpp"
#include "dermis/learn/recognition/recogniser.hpp"

int main(int argc, char** argv) {
  using namespace dermis::learn::recognition;  // NOLINT(google-build-using-namespace)
  const std::string folder = argc > 1 ? argv[1] : ".";
  if (!std::filesystem::exists(folder + "/frames.npy")) {
    std::printf("skipped: no postures are learned, for there is no %s/frames.npy\n", folder.c_str());
    return 0;
  }
  const auto refuse = [](const dermis::Error& error) {
    std::fprintf(stderr, "%s\n", error.message.c_str());
    return 2;
  };
  const auto data = read_dataset({.frames = folder + "/frames.npy",
                                  .arrays = folder + "/arrays.csv",
                                  .extras = {},
                                  .labels = folder + "/labels.csv"});
  if (!data) return refuse(data.error());
  const auto set = LearningSet::create(*data);
  if (!set) return refuse(set.error());

  const std::string& newcomer = data->labels.back().group;
  std::vector<std::size_t> taught;
  for (std::size_t i = 0; i < data->labels.size(); ++i) {
    if (data->labels[i].group != newcomer) taught.push_back(i);
  }
  const auto learned = set->learn(taught);
  if (!learned) return refuse(learned.error());
  auto recogniser = Recogniser::create(learned->classes, data->layout, data->longest());
  if (!recogniser) return refuse(recogniser.error());

  int asked = 0;
  int right = 0;
  for (const Label& label : data->labels) {
    if (label.group != newcomer) continue;
    const Answer answer = recogniser->recognise(data->segment(label));
    ++asked;
    right += learned->classes.names[answer.likeliest] == label.name ? 1 : 0;
  }
  std::printf("%zu postures learned from %zu maps; of person %s, %d of %d are right\n", learned->classes.names.size(),
              taught.size(), newcomer.c_str(), right, asked);
  return 0;
}
