// SPDX-License-Identifier: BSD-3-Clause
#include "core/work_ahead.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

namespace planemap {
namespace {

using namespace std::chrono_literals;

struct Item {
    int number = 0;
    int prepared_by = -1;
};

/// Reads the numbers from 1 to `count`; at `throws_at` it throws instead, once the others are away.
class Numbers {
  public:
    explicit Numbers(int count, int throws_at = 0) : count_(count), throws_at_(throws_at) {}

    WorkAhead<Item>::Work work() {
        return {[this](Item& item) { return read(item); },
                [this](Item& item, int worker) { prepare(item, worker); }};
    }
    int read_so_far() const { return read_; }
    bool were_apart() const { return were_apart_; }

  private:
    bool read(Item& item) {
        if (is_reading_.exchange(true)) were_apart_ = false;
        item.number = ++read_;
        if (item.number == throws_at_) throw std::runtime_error("the disk is gone");
        is_reading_ = false;
        return item.number < count_;
    }
    /// Odd ones take longer, so that they are ready after those behind them.
    void prepare(Item& item, int worker) {
        if (working_[worker].exchange(true)) were_apart_ = false;
        std::this_thread::sleep_for(item.number % 2 == 1 ? 300us : 20us);
        item.prepared_by = worker;
        working_[worker] = false;
    }

    int count_, throws_at_;
    std::atomic<int> read_ = 0;
    std::atomic<bool> is_reading_ = false, working_[8] = {}, were_apart_ = true;
};

class WithThreads : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(WorkAhead, WithThreads, testing::Values(1, 2, 4));

TEST_P(WithThreads, GivesAllInOrderAndThenNothing) {
    Numbers numbers(200);
    WorkAhead<Item> ahead(GetParam(), static_cast<std::size_t>(GetParam()), numbers.work());
    for (int i = 1; i <= 200; ++i) {
        const std::optional<Item> item = ahead.take();
        ASSERT_TRUE(item);
        ASSERT_EQ(item->number, i);
        if (GetParam() == 1) {
            ASSERT_EQ(item->prepared_by, -1) << "its user does that";
        }
    }
    EXPECT_FALSE(ahead.take());
    EXPECT_FALSE(ahead.take()) << "and does not wait for it";
    EXPECT_EQ(numbers.read_so_far(), 200);
    EXPECT_TRUE(numbers.were_apart()) << "one reads at a time, and no worker is two threads";
}

TEST_P(WithThreads, ThrowsWhatReadingThrewBehindWhatWasRead) {
    Numbers numbers(200, 7);
    WorkAhead<Item> ahead(GetParam(), 4, numbers.work());
    for (int i = 1; i < 7; ++i) {
        std::this_thread::sleep_for(1ms);  // it was read by then
        const std::optional<Item> item = ahead.take();
        ASSERT_TRUE(item);
        EXPECT_EQ(item->number, i);
    }
    EXPECT_THROW(ahead.take(), std::runtime_error);
    EXPECT_FALSE(ahead.take()) << "nothing is read after that";
    EXPECT_EQ(numbers.read_so_far(), 7);
}

TEST(WorkAhead, OneThreadReadsNothingBeforeItIsTaken) {
    Numbers numbers(200);
    WorkAhead<Item> ahead(1, 3, numbers.work());
    std::this_thread::sleep_for(20ms);
    EXPECT_EQ(numbers.read_so_far(), 0);
    ahead.take();
    EXPECT_EQ(numbers.read_so_far(), 1);
}

TEST(WorkAhead, ReadsAndPreparesAheadAsFarAsThereIsRoom) {
    Numbers numbers(200);
    WorkAhead<Item> ahead(2, 3, numbers.work());
    while (numbers.read_so_far() < 3) std::this_thread::sleep_for(1ms);
    std::this_thread::sleep_for(20ms);
    EXPECT_EQ(numbers.read_so_far(), 3);
    for (int i = 1; i <= 3; ++i) EXPECT_EQ(ahead.take()->number, i);
    EXPECT_LE(numbers.read_so_far(), 6);
}

TEST(WorkAhead, ThrowsWhatPreparingThrewInItsPlaceAndGoesOn) {
    std::atomic<int> read = 0, prepared = 0;
    WorkAhead<Item> ahead(2, 2,
                          {[&](Item& item) { return (item.number = ++read) < 3; },
                           [&](Item& item, int) {
                               ++prepared;
                               if (item.number == 2) throw std::runtime_error("no memory");
                           }});
    while (prepared < 2) std::this_thread::sleep_for(1ms);
    EXPECT_EQ(ahead.take()->number, 1);
    EXPECT_THROW(ahead.take(), std::runtime_error);
    EXPECT_EQ(ahead.take()->number, 3);
    EXPECT_FALSE(ahead.take());
}

TEST(WorkAhead, StopsWhileItIsFullOrAtWork) {
    for (const auto pause : {0us, 300us, 5000us}) {
        Numbers numbers(1000000);
        WorkAhead<Item> ahead(4, 4, numbers.work());
        ahead.take();
        std::this_thread::sleep_for(pause);
        ahead.stop();
        const int read = numbers.read_so_far();
        EXPECT_LE(read, 5);
        EXPECT_FALSE(ahead.take());
        EXPECT_EQ(numbers.read_so_far(), read);
    }
}

TEST(WorkAhead, WhoTakesWorksWhileItWaits) {
    std::atomic<int> read = 0;
    std::atomic<bool> helped = false;
    WorkAhead<Item> ahead(2, 2,
                          {[&](Item& item) { return (item.number = ++read) < 3; },
                           [&](Item& item, int worker) {
                               if (item.number == 1 && worker == 1)
                                   while (!helped)
                                       std::this_thread::sleep_for(1ms);  // until the second is prepared
                               if (item.number == 2) helped = true;
                               item.prepared_by = worker;
                           }});
    while (read < 1) std::this_thread::sleep_for(1ms);
    std::this_thread::sleep_for(20ms);
    const std::optional<Item> first = ahead.take();
    EXPECT_EQ(first->number, 1);
    EXPECT_EQ(ahead.take()->number, 2);
}

}  // namespace
}  // namespace planemap
