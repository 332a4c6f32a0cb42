#include "app/sim_loop.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <thread>

#include "recording_support.h"

namespace spherule::app {
namespace {

using namespace std::chrono_literals;

// A SimLoop with one sphere that lies on the floor, and a viewer that takes frames.
class Looping : public testing::Test {
  protected:
    Looping() {
        recording::writeFile(folder_ / "one.json", R"({"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]},
            "groups": [{"list": {"spheres": [{"position": [0.5, 0.5, 0.05]}]}, "radius": {"constant": 0.05}}]})");
        thread_ = std::jthread([this](const std::stop_token& stop) {
            SimLoop loop(World::open("cpu:1", folder_ / "one.json", {}).value(), {requests_, live_, outlets()},
                         quality::ownTable(), TapeOptions());
            EXPECT_TRUE(loop.run(stop));
        });
    }

    void tell(const v1::Command& command) { ASSERT_FALSE(requests_.push({.session = 1, .command = command})); }
    void step(std::uint32_t count) {
        v1::Command command;
        command.mutable_step()->set_count(count);
        tell(command);
    }
    // Waits for the first frame of a step.
    v1::Frame frameOf(std::uint64_t step) {
        std::unique_lock lock(mutex_);
        v1::Frame found;
        EXPECT_TRUE(changed_.wait_for(lock, 15s, [&] {
            for (const v1::Frame& frame : frames_) {
                if (frame.step() != step) continue;
                found = frame;
                return true;
            }
            return false;
        }));
        return found;
    }

  private:
    Outlets outlets() {
        return {.retain = [](const codec::SharedMessage&) {},
                .broadcast = [](const codec::SharedMessage&) {},
                .order = [](const codec::SharedMessage&) {},
                .frame =
                    [this](const codec::EncodedFrame& encoded) {
                        const std::scoped_lock lock(mutex_);
                        frames_.push_back(encoded.message->content().frame());
                        changed_.notify_all();
                    },
                .reply = [](std::uint64_t, const v1::CommandResult&) {},
                .viewers = [] { return 1U; },
                .subscriptions =
                    [] {
                        return std::vector<codec::Subscription>{{.rendition = {v1::NORMAL, 60}}};
                    }};
    }

    recording::TemporaryFolder folder_;
    Requests requests_;
    Live live_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<v1::Frame> frames_;
    std::jthread thread_;
};

TEST_F(Looping, AFrameOfAPausedWorldTellsHowManySleepInIt) {
    v1::Command reset;
    reset.mutable_reset();
    v1::Command fast;
    fast.mutable_set()->set_speed(10);
    v1::Command pause;
    pause.mutable_pause();
    tell(pause);
    tell(reset);
    tell(fast);
    EXPECT_EQ(frameOf(0).status().sleeping(), 0U);
    // These steps take less time than the interval of diagnostics.
    step(60);
    EXPECT_EQ(frameOf(60).status().sleeping(), 1U);
    EXPECT_TRUE(frameOf(60).status().paused());
}

}  // namespace
}  // namespace spherule::app
