// Values as bytes.
#include <gtest/gtest.h>

#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "core/archive.h"

namespace spherule {
namespace {

struct Part {
    double number = 0;
    std::string text;

    template <class Archive>
    void archive(Archive& a) {
        a(number, text);
    }
    bool operator==(const Part&) const = default;
};

enum class Colour : std::uint8_t { Red, Blue };

struct Whole {
    bool yes = false;
    Colour colour{};
    std::uint64_t count = 0;
    glm::dvec3 place{};
    std::array<bool, 3> flags{};
    std::vector<float> floats;
    std::vector<Part> parts;
    std::deque<std::uint32_t> queue;
    std::optional<Part> maybe;
    std::variant<double, Part, std::vector<Part>> kind;
    std::shared_ptr<const Part> shared;

    bool operator==(const Whole& other) const {
        const auto members = [](const Whole& one) {
            return std::tie(one.yes, one.colour, one.count, one.place, one.flags, one.floats, one.parts, one.queue,
                            one.maybe, one.kind);
        };
        return members(*this) == members(other) && (shared != nullptr) == (other.shared != nullptr) &&
               (!shared || *shared == *other.shared);
    }
};

template <class Archive>
void archive(Archive& a, Whole& whole) {
    auto& [yes, colour, count, place, flags, floats, parts, queue, maybe, kind, shared] = whole;
    a(yes, colour, count, place, flags, floats, parts, queue, maybe, kind, shared);
}

Whole example() {
    return {.yes = true,
            .colour = Colour::Blue,
            .count = ~std::uint64_t{0},
            .place = {0.1, -std::numeric_limits<double>::infinity(), 5e-324},
            .flags = {true, false, true},
            .floats = {1.5F, -0.0F},
            .parts = {{0.5, "a"}, {}, {1, std::string("\0b", 2)}},
            .queue = {3, 1, 2},
            .maybe = Part{2, "c"},
            .kind = std::vector<Part>{{7, "d"}},
            .shared = std::make_shared<const Part>(Part{9, "e"})};
}

std::string bytesOf(const Whole& whole) {
    Saver saver;
    saver(whole);
    return saver.take();
}

TEST(Archive, GivesTheSameValues) {
    for (const Whole& whole : {example(), Whole{}}) {
        const std::string bytes = bytesOf(whole);
        Loader loader(bytes);
        Whole loaded = example();
        loader(loaded);
        EXPECT_TRUE(loader.ok());
        EXPECT_EQ(loader.left(), 0U);
        EXPECT_EQ(loaded, whole);
        EXPECT_EQ(bytesOf(loaded), bytes);
    }
}

TEST(Archive, RefusesBytesThatAreCutOff) {
    const std::string bytes = bytesOf(example());
    for (std::size_t end = 0; end < bytes.size(); ++end) {
        Loader loader(std::string_view(bytes).substr(0, end));
        Whole loaded;
        loader(loaded);
        EXPECT_FALSE(loader.ok()) << end;
    }
}

TEST(Archive, RefusesValuesThatATypeDoesNotHave) {
    const auto refuses = [](const std::string& bytes, auto value) {
        Loader loader(bytes);
        loader(value);
        return !loader.ok();
    };
    EXPECT_TRUE(refuses("\2", false));
    EXPECT_TRUE(refuses("\2", std::variant<bool, float>()));
    EXPECT_TRUE(refuses("\7", std::optional<bool>()));
}

// No memory is allocated for elements that cannot follow.
TEST(Archive, RefusesSizesBeyondTheBytes) {
    for (const std::uint64_t size : {std::uint64_t{2}, std::uint64_t{1} << 40U, ~std::uint64_t{0}}) {
        Saver saver;
        saver(size, std::uint8_t{1});
        const auto refuses = [&](auto list) {
            Loader loader(saver.bytes());
            loader(list);
            return !loader.ok() && list.size() < 2;
        };
        EXPECT_TRUE(refuses(std::vector<double>()));
        EXPECT_TRUE(refuses(std::vector<std::string>()));
        EXPECT_TRUE(refuses(std::deque<std::uint8_t>()));
        EXPECT_TRUE(refuses(std::string()));
    }
}

}  // namespace
}  // namespace spherule
