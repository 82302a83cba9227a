// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/contacts/small_contact_table.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "touch/contacts/patch_response.hpp"

namespace dermis::touch::contacts {
namespace {

constexpr float kRelativeNoise = 0.01F;  // of a pressed taxel
constexpr float kHertzWeight = 0.7F;
constexpr std::size_t kPlaces = 44;  // a side
constexpr std::size_t kRadii = 32;
constexpr double kMostAway = 0.58;      // of a patch from its strongest taxel [pitch]
constexpr float kLeastShare = 1e-4F;    // of a patch on its strongest taxel
constexpr float kMostShare = 1.2F;      // of any taxel against the strongest, noise included
constexpr float kMostExponent = 12.0F;  // less likely than exp(-this) is left out

/// Centres of kPlaces equal parts of -1 ... 1.
double place_between_ends(std::size_t index) {
  return (2.0 * static_cast<double>(index) + 1.0) / static_cast<double>(kPlaces) - 1.0;
}

/// Likelihood of a share at each knot of its root. The knots lie as dense as linear interpolation needs, so a knot
/// stands for all values nearer to it than to others.
template <std::size_t Knots>
struct Likelihood {
  Likelihood(float share, float noise) {
    constexpr float kStep = 1.0F / static_cast<float>(Knots - 1);
    for (std::size_t k = 0; k < Knots; ++k) {
      const float root = static_cast<float>(k) * kStep;
      const float cell = (k == 0 ? 0.15F * kStep : 0.8F * root) * kStep;
      const float relative = kRelativeNoise * share;
      const float variance = noise * noise + cell * cell + relative * relative;
      const float off = root * root - share;
      const float exponent = 0.5F * off * off / variance;
      if (exponent > kMostExponent) continue;
      values[k] = std::exp(-exponent) / std::sqrt(variance);
      first = std::min(first, k);
      end = k + 1;
    }
  }
  std::array<float, Knots> values{};
  std::size_t first = Knots;
  std::size_t end = 0;
};

/// A place between two knots.
struct Between {
  Between(float place, std::size_t knots) {
    const float clamped = std::clamp(place, 0.0F, static_cast<float>(knots) - 1.001F);
    knot = static_cast<std::size_t>(clamped);
    upper = clamped - static_cast<float>(knot);
  }
  [[nodiscard]] float weight(std::size_t side) const noexcept { return side == 0 ? 1.0F - upper : upper; }
  std::size_t knot = 0;
  float upper = 0.0F;
};

float root_place(float share, std::size_t knots) {
  return std::sqrt(std::clamp(share, 0.0F, 1.0F)) * static_cast<float>(knots - 1);
}

}  // namespace

std::shared_ptr<const SmallContactTable> SmallContactTable::of(const TaxelSpacing& spacing,
                                                               const PatchResponses& responses) {
  thread_local std::vector<std::pair<TaxelSpacing, std::weak_ptr<const SmallContactTable>>> known;
  std::erase_if(known, [](const auto& entry) { return entry.second.expired(); });
  for (const auto& [other, table] : known) {
    if (other == spacing) return table.lock();
  }
  auto table = std::make_shared<const SmallContactTable>(spacing, responses);
  known.emplace_back(spacing, table);
  return table;
}

SmallContactTable::SmallContactTable(const TaxelSpacing& spacing, const PatchResponses& responses)
    : knots_(kNoises * kKnots) {
  add_samples(spacing, responses);
  normalise();
}

void SmallContactTable::add_samples(const TaxelSpacing& spacing, const PatchResponses& responses) {
  const double pitch = std::sqrt(spacing.col_pitch * spacing.row_pitch);
  for (std::size_t r = 0; r < kRadii; ++r) {
    const double radius = 0.1 * pitch * std::pow(20.0, static_cast<double>(r) / (kRadii - 1));
    const bool is_hertz = r % 2 == 0;
    Sample sample;
    sample.log_radius = static_cast<float>(std::log(radius));
    sample.weight = (is_hertz ? kHertzWeight : 1.0F - kHertzWeight) * static_cast<float>(radius);
    const PatchResponse::Row response =
        responses.of(is_hertz ? PatchProfile::hertz : PatchProfile::flat).row(sample.log_radius);
    for (std::size_t i = 0; i < kPlaces; ++i) {
      for (std::size_t k = 0; k < kPlaces; ++k) {
        sample.x = static_cast<float>(kMostAway * spacing.col_pitch * place_between_ends(i));
        sample.y = static_cast<float>(kMostAway * spacing.row_pitch * place_between_ends(k));
        if (respond(spacing, response, sample)) add(sample);
      }
    }
  }
}

bool SmallContactTable::respond(const TaxelSpacing& spacing, const PatchResponse::Row& response, Sample& sample) {
  std::array<float, 16> shares{};
  for (std::size_t taxel = 0; taxel < shares.size(); ++taxel) {
    const double col = static_cast<double>(taxel % 4) - 1.0;
    const std::size_t rows = taxel / 4;
    const double row = static_cast<double>(rows) - 1.0;
    const auto dx = static_cast<float>(col * spacing.col_pitch) - sample.x;
    const auto dy = static_cast<float>(row * spacing.row_pitch) - sample.y;
    shares[taxel] = response.share(std::sqrt(dx * dx + dy * dy));
  }
  constexpr std::array<std::size_t, 4> kBlock{5, 6, 9, 10};
  const float strongest = shares[kBlock[0]];
  if (strongest < kLeastShare) return false;
  for (float& share : shares) share /= strongest;
  sample.across = shares[kBlock[1]];
  sample.down = shares[kBlock[2]];
  sample.diagonal = shares[kBlock[3]];
  for (const std::size_t taxel : kBlock) shares[taxel] = 0.0F;
  sample.others = 0.0F;
  for (const float share : shares) sample.others += share * share;
  return std::max({sample.across, sample.down, sample.diagonal}) < kMostShare;
}

void SmallContactTable::add(const Sample& sample) {
  for (std::size_t level = 0; level < kNoises; ++level) {
    const float noise = kLeastNoise * std::pow(10.0F, static_cast<float>(level) / kNoisesPerDecade);
    const float exponent = 0.5F * sample.others / (noise * noise);
    if (exponent > kMostExponent) continue;
    const float weight = sample.weight * std::exp(-exponent);
    const Likelihood<kAcross> across(sample.across, noise);
    const Likelihood<kAcross> down(sample.down, noise);
    const Likelihood<kDiagonal> diagonal(sample.diagonal, noise);
    for (std::size_t i = across.first; i < across.end; ++i) {
      for (std::size_t k = down.first; k < down.end; ++k) {
        const float both = weight * across.values[i] * down.values[k];
        Knot* const line = &knots_[level * kKnots + (i * kAcross + k) * kDiagonal];
        for (std::size_t d = diagonal.first; d < diagonal.end; ++d) {
          const float likelihood = both * diagonal.values[d];
          line[d][0] += likelihood;
          line[d][1] += likelihood * sample.x;
          line[d][2] += likelihood * sample.y;
          line[d][3] += likelihood * sample.x * sample.x;
          line[d][4] += likelihood * sample.y * sample.y;
          line[d][5] += likelihood * sample.log_radius;
        }
      }
    }
  }
}

void SmallContactTable::normalise() {
  for (Knot& knot : knots_) {
    const float weight = knot[0];
    if (weight <= 0.0F) continue;
    for (float& value : knot) value /= weight;
    knot[3] = std::max(0.0F, knot[3] - knot[1] * knot[1]);
    knot[4] = std::max(0.0F, knot[4] - knot[2] * knot[2]);
  }
}

std::optional<SmallContactPlace> SmallContactTable::find(const SmallContact& contact) const noexcept {
  const Between noise(kNoisesPerDecade * std::log10(std::max(contact.noise, kLeastNoise) / kLeastNoise), kNoises);
  const Between across(root_place(contact.across, kAcross), kAcross);
  const Between down(root_place(contact.down, kAcross), kAcross);
  const Between diagonal(root_place(contact.diagonal, kDiagonal), kDiagonal);
  Knot sum{};
  for (std::size_t corner = 0; corner < 16; ++corner) {
    const std::size_t n = corner >> 3U;
    const std::size_t i = (corner >> 2U) & 1U;
    const std::size_t k = (corner >> 1U) & 1U;
    const std::size_t d = corner & 1U;
    const float weight = noise.weight(n) * across.weight(i) * down.weight(k) * diagonal.weight(d);
    const Knot& knot = knots_[(noise.knot + n) * kKnots + ((across.knot + i) * kAcross + down.knot + k) * kDiagonal +
                              diagonal.knot + d];
    for (std::size_t value = 0; value < kValues; ++value) sum[value] += weight * knot[value];
  }
  constexpr float kLeastKnown = 0.3F;
  if (sum[0] < kLeastKnown) return {};
  for (float& value : sum) value /= sum[0];
  return SmallContactPlace{sum[1], sum[2], sum[3], sum[4], sum[5]};
}

}  // namespace dermis::touch::contacts
