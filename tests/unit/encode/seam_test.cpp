// The decoder restores positions that repeat along periodic axes. A crossing of the seam costs no bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "codec/decoder.h"
#include "codec_support.h"

namespace spherule::codec {
namespace {

constexpr double quantum = 0.01;
const glm::dvec3 periods{1.003, 0, 2.0};

encode::ColumnEncoder::Grid grid(bool turns) {
    return {.quantum = quantum, .periods = periods, .turns = turns};
}

double wrapped(double x, double period) {
    return period > 0 ? x - period * std::floor(x / period + 0.5) : x;
}

// Spheres that fly, some of them outside the bounds by less than a length, as between two rebuilds of the lists.
class Flight {
  public:
    explicit Flight(std::uint32_t spheres, double speed, glm::dvec3 begin = glm::dvec3(0))
        : places_(spheres), steps_(spheres), begin_(begin) {
        for (std::uint32_t k = 0; k < spheres; ++k)
            for (int axis = 0; axis < 3; ++axis) {
                places_[k][axis] = draw(0.02);
                steps_[k][axis] = speed + draw(0.05 * speed);
            }
    }

    Positions next() {
        Positions now;
        for (std::size_t k = 0; k < places_.size(); ++k) {
            places_[k] += steps_[k];
            glm::dvec3 place = begin_ + places_[k];
            for (int axis = 0; axis < 3; ++axis)
                if (periods[axis] > 0) place[axis] = wrapped(place[axis], periods[axis]) + (k % 4 == 0 ? 0.2 : 0);
            now.emplace_back(glm::vec3(place), 1);
        }
        return now;
    }

  private:
    double draw(double reach) { return reach * (2 * std::uniform_real_distribution<double>()(random_) - 1); }

    std::mt19937_64 random_{3};
    std::vector<glm::dvec3> places_, steps_;
    glm::dvec3 begin_;
};

// Expects that the decoder has the positions, or images of them, within half a quantum.
void expectSame(const Decoder& decoder, const Positions& positions, bool turns) {
    for (std::size_t k = 0; k < positions.size(); ++k)
        for (int axis = 0; axis < 3; ++axis) {
            const std::uint32_t each = decoder.turns()[axis];
            EXPECT_EQ(each > 0, turns && periods[axis] > 0);
            const double step = each > 0 ? periods[axis] / each : quantum;
            EXPECT_LE(step, quantum);
            const int q = decoder.newest()[k][axis];
            if (each > 0) {
                EXPECT_GE(q, -static_cast<int>(each / 2));
                EXPECT_LT(q, static_cast<int>(each - each / 2));
            }
            const double off = wrapped(step * q - static_cast<double>(positions[k][axis]), periods[axis]);
            EXPECT_LE(std::abs(off), quantum / 2 + 1e-6) << k << ", axis " << axis;
            if (periods[axis] > 0) {
                EXPECT_LE(std::abs(step * q), periods[axis] / 2 + quantum);
            }
        }
}

TEST(CodecSeam, PositionsAreRestoredWithAndWithoutTurns) {
    for (const bool turns : {true, false}) {
        constexpr std::uint32_t spheres = 200;
        Encoder encoder("cpu:1", spheres, grid(turns));
        Decoder decoder(spheres);
        Flight flight(spheres, 0.07);
        for (int frame = 0; frame < 80; ++frame) {
            const Positions positions = flight.next();
            const Bytes bytes = frame == 0 ? encoder.begin(positions) : encoder.next(positions);
            const auto head = decoder.apply(bytes);
            ASSERT_TRUE(head) << head.error().text();
            expectSame(decoder, positions, turns);
            if (frame % 13 != 5) continue;
            Decoder joined(spheres);
            ASSERT_TRUE(joined.apply(encoder.join()));
            expectSame(joined, positions, turns);
            decoder = joined;
        }
    }
}

// Positions outside the bounds, or not finite, are moved to a place inside.
TEST(CodecSeam, PlacesOutsideAreMovedBack) {
    const Positions positions{{0.75F, 0, -1.5F, 1}, {-0.75F, 3, 1.5F, 1}, {NAN, 1, INFINITY, 1}, {-INFINITY, 0, 0, 1}};
    for (const bool turns : {true, false}) {
        Encoder encoder("cpu:1", 4, grid(turns));
        Decoder decoder(4);
        ASSERT_TRUE(decoder.apply(encoder.begin(positions)));
        expectSame(decoder, {positions[0], positions[1]}, turns);
        const Bytes next = encoder.next(positions);
        ASSERT_TRUE(decoder.apply(next));
        expectSame(decoder, {positions[0], positions[1]}, turns);
    }
}

// The same flight, across the seam and far from it.
std::size_t bytesOf(bool turns, const glm::dvec3& begin) {
    constexpr std::uint32_t spheres = 640;
    Encoder encoder("cpu:1", spheres, grid(turns));
    Flight flight(spheres, 0.004, begin);
    encoder.begin(flight.next());
    std::size_t sum = 0;
    for (int frame = 0; frame < 20; ++frame) sum += encoder.next(flight.next()).size();
    return sum;
}

TEST(CodecSeam, CrossingItCostsNothing) {
    const glm::dvec3 seam(0.5 * periods.x - 0.05, 0, 0.5 * periods.z - 0.05);
    const auto middle = static_cast<double>(bytesOf(true, glm::dvec3(0)));
    EXPECT_NEAR(static_cast<double>(bytesOf(true, seam)) / middle, 1, 0.01);
    EXPECT_GT(static_cast<double>(bytesOf(false, seam)) / middle, 1.1) << "what viewers without turns pay";
}

TEST(CodecSeam, InvalidTurnsAreRefused) {
    const Positions positions{{0.1F, 0, 0, 1}};
    Encoder encoder("cpu:1", 1, grid(true));
    const Bytes key = encoder.begin(positions);
    const auto reason = [](Bytes frame, std::size_t word, std::uint32_t value, std::size_t size = 0) {
        std::memcpy(&frame[4 * word], &value, sizeof value);
        if (size > 0) frame.resize(size);
        Decoder decoder(1);
        const auto head = decoder.apply(frame);
        return head ? "" : head.error().text();
    };
    EXPECT_EQ(reason(key, 5, 0), "");
    EXPECT_EQ(reason(key, 5, 1), "frame, head: has 1 turns");
    EXPECT_EQ(reason(key, 6, (1U << 30U) + 1), "frame, head: has 1073741825 turns");
    EXPECT_EQ(reason(key, 5, 0, 24), "frame, head: has 24 bytes of 28");
    Decoder decoder(1);
    ASSERT_TRUE(decoder.apply(key));
    Bytes next = encoder.next(positions);
    next[16] ^= std::byte{2};
    EXPECT_EQ(decoder.apply(next).error().text(), "frame, head: has other turns than the frame before");
    EXPECT_TRUE(decoder.wantsKeyframe());
}

}  // namespace
}  // namespace spherule::codec
