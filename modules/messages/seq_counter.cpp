// SPDX-License-Identifier: BSD-3-Clause
#include "messages/seq_counter.hpp"

namespace planemap::messages {

namespace {
constexpr std::int64_t kWindow = 64;  // numbers that are remembered one by one

/// How far b is after a, over the wrap-around.
std::int64_t steps(std::uint32_t a, std::uint32_t b) {
    return static_cast<std::int32_t>(b - a);
}
}  // namespace

void SeqCounter::start(std::uint32_t seq) {
    last_ = seq;
    seen_ = ~std::uint64_t{0};  // what came before counts as nothing missed
    jump_.reset();
}

void SeqCounter::add(std::uint32_t seq) {
    if (!last_) return start(seq);
    const std::int64_t ahead = steps(*last_, seq);
    if (ahead > 0 && ahead < kWindow) {
        missed_ += ahead - 1;
        seen_ = seen_ << ahead | 1;
        last_ = seq;
        jump_.reset();
    } else if (ahead <= 0 && ahead > -kWindow) {
        const std::uint64_t bit = std::uint64_t{1} << -ahead;
        if ((seen_ & bit) == 0) --missed_;
        seen_ |= bit;
    } else if (jump_ && steps(*jump_, seq) > 0 && steps(*jump_, seq) < kWindow) {
        const std::int64_t jumped = steps(*last_, *jump_);
        if (jumped > 0)
            missed_ += jumped - 1;
        else
            ++restarts_;
        start(*jump_);
        add(seq);
    } else {
        jump_ = seq;
    }
}

}  // namespace planemap::messages
