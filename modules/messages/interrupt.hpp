// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace planemap::messages {

/// Ends the wait of a bus for a tcpq server that takes or sends no more bytes of a message; the connection is
/// lost by it. Of its own accord liblcm goes on with the rest of a message after a signal. May be called in a
/// signal handler.
void interrupt_waiting();

}  // namespace planemap::messages
