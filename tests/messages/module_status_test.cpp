// SPDX-License-Identifier: BSD-3-Clause
#include "messages/module_status.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "messages/decode.hpp"
#include "messages/told_status.hpp"

namespace planemap::messages {
namespace {

class Status : public testing::Test {
  protected:
    Status() {
        bus_.subscribe("PLANEMAP_STATUS_GRAPH",
                       [this](const RawMessage& m) { last_ = decode<module_status_t>(m.bytes); });
    }
    const module_status_t& at(std::int64_t second, bool stopped = false) {
        status_.publish_if_due(bus_, second * 1000000, stopped);
        bus_.drain();
        return last_;
    }
    Bus bus_{"memq://"};
    ModuleStatus status_{"graph"};
    module_status_t last_{};
};

TEST_F(Status, CountsInputsGapsAndErrors) {
    at(1);
    for (const std::uint32_t seq : {0u, 1u, 4u, 5u}) {
        const ModuleStatus::Work work(status_);
        status_.received(seq);
        status_.published();
    }
    const auto handler = status_.guard([](const RawMessage&) { throw MessageError("bad"); });
    EXPECT_THROW(handler({}), MessageError);
    const module_status_t& m = at(3);
    EXPECT_EQ(m.module, "graph");
    EXPECT_EQ(m.received, 4);
    EXPECT_EQ(m.gaps, 2);
    EXPECT_EQ(m.decode_errors, 1);
    EXPECT_DOUBLE_EQ(m.rate_hz, 2.0);
    EXPECT_EQ(m.state, module_status_t::RUNNING);
    EXPECT_NE(status_.line().find("running: 2.0 Hz"), std::string::npos) << status_.line();
}

TEST_F(Status, WorkIsTimedByTheWallAndByTheThread) {
    {
        const ModuleStatus::Work work(status_);
        const double start_ms = thread_cpu_ms();
        while (thread_cpu_ms() - start_ms < 20) {
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(60));
    }
    EXPECT_EQ(status_.work_ms().count(), 1);
    EXPECT_EQ(status_.work_cpu_ms().count(), 1);
    EXPECT_GT(status_.work_ms().sum(), 75);
    EXPECT_GT(status_.work_cpu_ms().sum(), 19);
    EXPECT_LT(status_.work_cpu_ms().sum(), 45) << "sleep is no work";
}

TEST_F(Status, StatesFollowTheWork) {
    at(1);
    EXPECT_EQ(at(2).state, module_status_t::WAITING);
    status_.received();
    EXPECT_EQ(at(3).state, module_status_t::RUNNING) << "its work may take a while";
    status_.received();
    status_.published();
    EXPECT_EQ(at(4).state, module_status_t::RUNNING);
    EXPECT_EQ(at(5).state, module_status_t::IDLE);
    for (int second = 6; second < 12; ++second) {
        status_.received();
        const auto state = at(second).state;
        EXPECT_EQ(state, second < 8 ? module_status_t::RUNNING : module_status_t::FAILING)
            << "for three seconds input comes and nothing leaves: " << second;
    }
    status_.received();
    status_.published();
    EXPECT_EQ(at(13).state, module_status_t::RUNNING);
    EXPECT_EQ(at(14, true).state, module_status_t::STOPPED);
    EXPECT_EQ(status_.line().rfind("stopped", 0), 0u) << status_.line();
}

TEST_F(Status, AModuleThatCanUseNothingFailsAndDoesNotWait) {
    at(1);
    for (int i = 0; i < 14; ++i) {
        status_.received();
        status_.dropped();
    }
    EXPECT_EQ(status_.line().rfind("failing", 0), 0u)
        << "before the first second is over: " << status_.line();
    EXPECT_EQ(at(2).state, module_status_t::FAILING);
    ModuleStatus corrupt("graph");
    corrupt.publish_if_due(bus_, 1000000);
    const auto handler = corrupt.guard([](const RawMessage&) { throw MessageError("bad"); });
    EXPECT_THROW(handler({}), MessageError);
    corrupt.publish_if_due(bus_, 2000000);
    bus_.drain();
    EXPECT_EQ(last_.state, module_status_t::FAILING);
    // A side stream alone is something that came.
    ModuleStatus side("graph");
    side.publish_if_due(bus_, 1000000);
    side.guard([](const RawMessage&) {})({});
    side.publish_if_due(bus_, 2000000);
    bus_.drain();
    EXPECT_EQ(last_.state, module_status_t::IDLE);
}

TEST_F(Status, TheFirstLineDoesNotSayWaitingWhenInputCame) {
    at(1);
    at(2);
    for (int i = 0; i < 14; ++i) status_.received();
    EXPECT_EQ(status_.line().rfind("running", 0), 0u) << status_.line();
}

TEST_F(Status, ARestartOfTheSenderIsSaidAndIsNoGap) {
    for (const std::uint32_t seq : {500u, 501u, 0u, 1u, 2u}) status_.received(seq);
    at(1);
    const module_status_t& m = at(2);
    EXPECT_EQ(m.gaps, 0);
    EXPECT_NE(m.text.find("started again"), std::string::npos) << m.text;
}

TEST_F(Status, TellsWhatWasLost) {
    status_.set_text("well");
    status_.lost("regions out of range", 3);
    status_.lost("keyframes without a frame");
    status_.lost("regions out of range", 4);
    status_.lost("nothing", 0);
    at(1);
    const module_status_t m = at(2);
    EXPECT_EQ(m.text, "well; lost 1 keyframes without a frame; lost 7 regions out of range");
    EXPECT_EQ(m.dropped, 0);
    EXPECT_NE(status_.line().find("lost 7 regions out of range"), std::string::npos) << status_.line();
    EXPECT_EQ(status_.losses().size(), 2u);
}

TEST_F(Status, RunningMeansThatInputIsHandledNow) {
    at(1);
    status_.received();
    status_.published();
    EXPECT_EQ(at(2).state, module_status_t::RUNNING);
    status_.published();  // of what came before
    EXPECT_EQ(at(3).state, module_status_t::IDLE);
    EXPECT_EQ(last_.rate_hz, 0);
}

TEST_F(Status, ARemarkStaysUntilAnotherOfItsKind) {
    status_.set_text("well");
    status_.remark("sensor", "the sensor started again at 1 s");
    status_.remark("part", "a part");
    at(1);
    status_.set_text("better");
    status_.remark("sensor", "the sensor started again at 2 s");
    EXPECT_EQ(at(2).text, "better; a part; the sensor started again at 2 s");
    status_.remark("part", "");
    EXPECT_EQ(at(3).text, "better; the sensor started again at 2 s");
    EXPECT_EQ(status_.remarks().size(), 1u);
}

TEST_F(Status, OnceASecond) {
    EXPECT_FALSE(status_.publish_if_due(bus_, 1000000));
    EXPECT_FALSE(status_.publish_if_due(bus_, 1900000));
    EXPECT_TRUE(status_.publish_if_due(bus_, 2000000));
}

TEST(ModuleStatus, SaysHowOldOutputsAreWhenTheyLeaveIfStampsAreOfNow) {
    ModuleStatus status("odometry");
    status.published(1000000, 500000000);  // a recording's stamp
    status.published(2000000, 1000000);    // of the future
    EXPECT_EQ(test::told(status).age_median_ms, -1);
    for (int i = 0; i < 10; ++i) status.published(1000000, 1012000);
    for (int i = 0; i < 2; ++i) status.published(1000000, 1050000);
    EXPECT_NEAR(test::told(status).age_median_ms, 12, 0.2);
    EXPECT_NEAR(test::told(status).age_p95_ms, 50, 1);
    EXPECT_EQ(test::told(status).published, 14);
    EXPECT_NE(status.line().find("12 ms (p95 50) after the shutter"), std::string::npos) << status.line();
}

}  // namespace
}  // namespace planemap::messages
