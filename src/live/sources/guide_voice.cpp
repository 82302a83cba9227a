// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/guide_voice.hpp"

namespace dermis::live::sources {

void GuideVoice::speak(const GuideWords& words) {
  const std::lock_guard lock(mutex_);
  words_ = words;
}

GuideWords GuideVoice::words() const {
  const std::lock_guard lock(mutex_);
  return words_;
}

}  // namespace dermis::live::sources
