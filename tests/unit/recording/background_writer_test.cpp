// Tests of BackgroundWriter.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "recording/background_writer.h"
#include "recording_support.h"

namespace spherule::recording {
namespace {

using namespace std::chrono_literals;

codec::SharedMessage messageOf(std::size_t bytes) {
    v1::ServerMessage message;
    message.mutable_frame()->set_spb(std::string(bytes, 'x'));
    return codec::share(std::move(message));
}

BackgroundWriter::Progress ended(BackgroundWriter& writer) {
    for (int k = 0; k < 2000 && !writer.progress().ended; ++k) std::this_thread::sleep_for(5ms);
    return writer.progress();
}

// A pipe without a reader stands for a disk that does not write.
class SlowDisk : public testing::Test {
  protected:
    SlowDisk() {
        mkfifo(path_.c_str(), 0600);
        reader_ = open(path_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
        fcntl(reader_, F_SETPIPE_SZ, 1 << 20);
        writer_ = std::move(*BackgroundWriter::create(path_, true, 0));
    }
    ~SlowDisk() override {
        std::jthread drain([this](const std::stop_token& stop) {
            std::vector<char> bytes(1 << 20);
            while (!stop.stop_requested())
                if (read(reader_, bytes.data(), bytes.size()) <= 0) std::this_thread::sleep_for(1ms);
        });
        writer_.reset();
        drain.request_stop();
        drain.join();
        close(reader_);
    }

    TemporaryFolder folder_;
    std::string path_ = folder_ / "pipe";
    int reader_ = -1;
    std::unique_ptr<BackgroundWriter> writer_;
};

TEST_F(SlowDisk, DropsFramesWithoutBlocking) {
    const auto megabyte = messageOf(1'000'000);
    int taken = 0;
    while (taken < 1000 && writer_->add(Kind::Delta, taken, megabyte)) ++taken;
    EXPECT_GE(taken, 64);
    EXPECT_LT(taken, 140);  // queued records, and the record being written
    EXPECT_TRUE(writer_->add(Kind::Order, taken, megabyte));
    EXPECT_FALSE(writer_->progress().ended);
}

TEST_F(SlowDisk, LetsALogWaitAndFramesPass) {
    writer_->beginLog();
    std::atomic<int> taken = 0;
    std::jthread log([&] {
        const std::string megabyte(1'000'000, 'x');
        while (taken < 100) {
            writer_->addLog(megabyte);
            ++taken;
        }
    });
    for (int before = -1; before != taken;) {
        before = taken;
        std::this_thread::sleep_for(200ms);
    }
    EXPECT_LT(taken, 50);
    const auto megabyte = messageOf(1'000'000);
    for (int k = 0; k < 20; ++k) EXPECT_TRUE(writer_->add(Kind::Delta, k, megabyte));
    writer_->endLog();  // what waits is dropped
    log.join();
    EXPECT_EQ(taken, 100);
}

TEST_F(SlowDisk, LimitsRecordsThatFramesNeed) {
    const auto much = messageOf(10'000'000);
    for (int k = 0; k < 60; ++k) EXPECT_TRUE(writer_->add(Kind::Order, k, much));
    EXPECT_EQ(writer_->progress().failure, "the disk is too slow: 256 MiB wait to be written");
}

TEST(BackgroundWriter, EndsAfterItsLog) {
    const TemporaryFolder folder;
    auto writer = BackgroundWriter::create(folder / "film.sph", false, 0);
    ASSERT_TRUE(writer);
    (*writer)->beginLog();
    (*writer)->addLog("one");
    ASSERT_TRUE((*writer)->add(Kind::Keyframe, 3, messageOf(10)));
    (*writer)->finish();
    std::this_thread::sleep_for(50ms);
    EXPECT_FALSE((*writer)->progress().ended);
    ASSERT_TRUE((*writer)->add(Kind::Delta, 4, messageOf(10)));  // comes too late
    (*writer)->addLog("two");
    (*writer)->endLog();
    (*writer)->addLog("three");  // comes too late
    EXPECT_EQ(ended(**writer).failure, "");
    const auto file = RecordFile::open(folder / "film.sph");
    ASSERT_TRUE(file);
    const auto first = file->read(fileHeadBytes);
    const auto second = file->read(first->end);
    const auto third = file->read(second->end);
    EXPECT_EQ(first->kind, Kind::Log);
    EXPECT_EQ(first->payload, "one");
    EXPECT_EQ(second->kind, Kind::Keyframe);
    EXPECT_EQ(third->kind, Kind::Log);
    EXPECT_EQ(third->payload, "two");
    EXPECT_EQ(third->time, 3);
    EXPECT_EQ(file->read(third->end)->kind, Kind::Index);
}

TEST(BackgroundWriter, WritesAllRecordsBeforeItEnds) {
    const TemporaryFolder folder;
    auto writer = BackgroundWriter::create(folder / "film.sph", false, 0);
    ASSERT_TRUE(writer);
    for (int k = 0; k < 100; ++k) ASSERT_TRUE((*writer)->add(Kind::Delta, k, messageOf(1000)));
    (*writer)->finish();
    const auto progress = ended(**writer);
    EXPECT_EQ(progress.failure, "");
    EXPECT_EQ(progress.bytes, contentOf(folder / "film.sph").size());
    const auto file = RecordFile::open(folder / "film.sph");
    ASSERT_TRUE(file);
    std::uint64_t offset = fileHeadBytes;
    for (int k = 0; k < 100; ++k) {
        const auto record = file->read(offset);
        ASSERT_TRUE(record);
        EXPECT_EQ(record->time, k);
        offset = record->end;
    }
    EXPECT_EQ(file->read(offset)->kind, Kind::Index);
}

}  // namespace
}  // namespace spherule::recording
