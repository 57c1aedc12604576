// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace planemap::messages {

/// A message or a compressed image that cannot be used: what() says the type or channel, the field and the
/// reason. The sender's fault, never the process's: count it, say it once per burst, drop it, go on.
class MessageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The message is of another type, or of another version of it: nothing is wrong with its bytes.
class OtherTypeError : public MessageError {
  public:
    using MessageError::MessageError;
};

}  // namespace planemap::messages
