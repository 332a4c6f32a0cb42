#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "core/input_file.h"
#include "temporary_folder.h"

namespace spherule {
namespace {

namespace fs = std::filesystem;

class InputFiles : public ::testing::Test {
  protected:
    std::string write(const std::string& text) {
        path_ = folder_.write("file", text);
        return path_;
    }
    LineReader lines(const std::string& text) { return LineReader(*InputFile::open(write(text))); }
    // Makes every further read of the file fail, as if the disk had been removed.
    void breakReads() const {
        for (const auto& open : fs::directory_iterator("/proc/self/fd")) {
            std::error_code gone;
            if (fs::read_symlink(open.path(), gone) != path_ || gone) continue;
            const int writeOnly = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
            dup2(writeOnly, std::stoi(open.path().filename().string()));
            close(writeOnly);
            return;
        }
    }

    support::TemporaryFolder folder_;
    fs::path path_;
};

TEST_F(InputFiles, AreReadCompletely) {
    EXPECT_EQ(readFile(write(""), 10).value(), "");
    EXPECT_EQ(readFile(write("0123456789"), 10).value(), "0123456789");
    EXPECT_EQ(readFile(write("0123456789a"), 10).error().message, "has 11 bytes, at most 10 are allowed");
    const std::string large(300'000, 'x');
    EXPECT_EQ(readFile(write(large), large.size()).value(), large);
}

TEST_F(InputFiles, WithoutSizeAreReadUpToTheLimit) {
    EXPECT_GT(readFile("/proc/self/maps", 10 << 20).value().size(), 100U);
    EXPECT_EQ(readFile("/proc/self/maps", 100).error().text(),
              "/proc/self/maps: is longer than the 100 bytes that are allowed");
}

TEST_F(InputFiles, NonRegularFilesAreRefusedWithoutBlocking) {
    const std::string pipe = folder_ / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(readFile(pipe, 10).error().text(), pipe + ": is a pipe, must be a regular file");
    EXPECT_EQ(readFile("/dev/zero", 10).error().text(), "/dev/zero: is a device, must be a regular file");
    EXPECT_EQ(readFile("/tmp", 10).error().text(), "/tmp: is a folder, must be a regular file");
    EXPECT_EQ(readFile(folder_ / "none", 10).error().text(), (folder_ / "none") + ": there is no such file");
    EXPECT_EQ(readFile("/proc/self/mem", 10).error().text(), "/proc/self/mem: cannot be read: Input/output error");
}

TEST_F(InputFiles, AreReadLineByLine) {
    for (const std::size_t length : {0U, 1U, 65'534U, 65'535U, 65'536U, 70'000U}) {
        const std::string first(length, 'a');
        for (const char* const end : {"", "\n"}) {
            LineReader reader = lines(first + "\nb\r\n\nc" + end);
            for (const std::string& line : {first, std::string("b"), std::string(), std::string("c")}) {
                ASSERT_TRUE(reader.next(100'000).value());
                ASSERT_EQ(reader.line(), line);
            }
            EXPECT_EQ(reader.number(), 4U);
            EXPECT_FALSE(reader.next(100'000).value());
        }
    }
}

TEST_F(InputFiles, ByteOrderMarkIsRemoved) {
    LineReader reader = lines("\xef\xbb\xbfx\n\xef\xbb\xbfy\n");
    ASSERT_TRUE(reader.next(10).value());
    EXPECT_EQ(reader.line(), "x");
    ASSERT_TRUE(reader.next(10).value());
    EXPECT_EQ(reader.line(), "\xef\xbb\xbfy");
}

TEST_F(InputFiles, LineLengthIsLimited) {
    LineReader reader = lines("abc\nabcdef\n");
    ASSERT_TRUE(reader.next(5).value());
    EXPECT_EQ(reader.next(5).error().message, "the line is longer than 5 bytes");
    EXPECT_EQ(reader.number(), 2U);
}

TEST_F(InputFiles, ErrorIsNotEndOfFile) {
    std::string text;
    for (int k = 0; k < 50'000; ++k) text += "line\n";
    LineReader reader = lines(text);
    ASSERT_TRUE(reader.next(10).value());
    breakReads();
    auto more = reader.next(10);
    while (more && *more) more = reader.next(10);
    ASSERT_FALSE(more);
    EXPECT_EQ(more.error().text(), path_.string() + ": cannot be read: Bad file descriptor");
    EXPECT_LT(reader.number(), 50'000U);
}

}  // namespace
}  // namespace spherule
