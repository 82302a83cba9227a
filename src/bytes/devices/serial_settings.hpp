// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis::bytes::devices {

/// Raw bytes, 8 data bits, no parity, 1 stop bit, no flow control, at any baud, also one without a constant B<n>.
/// False: errno has the reason; the driver may also take a baud that is near and not this one (EINVAL).
[[nodiscard]] bool set_raw_8n1(int descriptor, unsigned baud);

}  // namespace dermis::bytes::devices
