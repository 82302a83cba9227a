// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/process_outputs.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "dermis/bytes/files/output_place.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

TEST(ProcessOutputs, hold_the_claims_of_whoever_shares_them) {
  const support::TemporaryFolder folder;
  ASSERT_TRUE(claim_output(folder.file("rec"), EarlierFile::stays_unread));
  share_process_outputs(process_outputs());
  const Result<OutputPlace> place = open_output(folder.file("rec"));
  ASSERT_TRUE(place) << place.error().message;
  ::close(place->descriptor);
}

}  // namespace
}  // namespace dermis::bytes::files
