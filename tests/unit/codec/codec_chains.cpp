// codec_chains SEED FILE: writes chains of random frames, valid and garbled, with the results of our decoder, for the
// comparison with other decoders. All numbers are 32 bits, little endian.
//
// A chain: number of spheres, number of frames, then the frames. A frame: its size and bytes; 1 if it was accepted,
// else 0; size and bytes of the error; newest positions. If the decoder has two states, then 1 and the previous
// positions, else 0.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "codec/decoder.h"
#include "codec_support.h"

namespace spherule::codec {
namespace {

using Random = std::mt19937_64;

std::uint32_t draw(Random& random, std::uint64_t below) {
    return static_cast<std::uint32_t>(random() % below);
}

void put(std::ostream& out, std::span<const std::byte> bytes) {
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

void put(std::ostream& out, std::size_t number) {
    const auto word = static_cast<std::uint32_t>(number);
    put(out, std::as_bytes(std::span(&word, 1)));
}

// Mostly small numbers, also at the limits of blocks, groups and chunks; sometimes several chunks.
std::uint32_t drawSpheres(Random& random) {
    constexpr std::array<std::uint32_t, 10> edges{1, 2, 63, 64, 65, 2047, 2048, 2049, 16384, 16385};
    const std::uint32_t kind = draw(random, 8);
    if (kind == 0) return edges[draw(random, edges.size())];
    if (kind == 1) return 1 + draw(random, 40'000);
    return 1 + draw(random, 1U << (4 + draw(random, 9)));
}

// Random positions, some of them NaN or infinite.
Positions wild(Random& random, std::uint32_t spheres) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    constexpr std::array<float, 7> odd{inf, -inf, std::numeric_limits<float>::quiet_NaN(), 3e38F, -3e38F, 1e9F, -1e9F};
    const auto reach = static_cast<float>(std::uint64_t{1} << draw(random, 40));
    std::uniform_real_distribution<float> place(-reach, reach);
    Positions positions(spheres);
    for (glm::vec4& p : positions)
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = draw(random, 200) == 0 ? odd[draw(random, odd.size())] : place(random);
    return positions;
}

Bytes garbled(Random& random, Bytes frame, const Bytes& other) {
    const auto at = [&] { return static_cast<std::ptrdiff_t>(draw(random, frame.size())); };
    switch (draw(random, 7)) {
        case 0:
            frame.resize(draw(random, frame.size()));
            break;
        case 1: {  // appends random bytes
            const std::size_t room = 1 + draw(random, 12);
            for (std::size_t k = 0; k < room; ++k) frame.push_back(static_cast<std::byte>(random()));
            break;
        }
        case 2: {  // joins its beginning and the end of another frame
            if (other.empty()) break;
            frame.resize(static_cast<std::size_t>(at()) & ~std::size_t{3});
            const auto from = static_cast<std::ptrdiff_t>(std::min(frame.size(), other.size()));
            frame.insert(frame.end(), other.begin() + from, other.end());
            break;
        }
        case 3:  // changes bytes of the head
            for (unsigned k = 1 + draw(random, 3); k > 0; --k)
                frame[draw(random, 24) % frame.size()] = static_cast<std::byte>(random());
            break;
        case 4:  // only random bytes
            std::ranges::generate(frame, [&] { return static_cast<std::byte>(random()); });
            break;
        default:  // flips bits after the head
            for (unsigned k = 1 + draw(random, 6); k > 0; --k) {
                const std::size_t byte = std::min<std::size_t>(16 + static_cast<std::size_t>(at()), frame.size() - 1);
                frame[byte] ^= std::byte(1U << draw(random, 8));
            }
    }
    return frame;
}

// Half of the chains have periodic axes, of 2 to 2^21 cells.
encode::ColumnEncoder::Grid gridOf(Random& random) {
    encode::ColumnEncoder::Grid grid{.quantum = 1, .turns = true};
    if (draw(random, 2) == 0) return grid;
    for (int axis = 0; axis < 3; ++axis)
        if (draw(random, 3) > 0) grid.periods[axis] = 2 + draw(random, 1U << (1 + draw(random, 21)));
    return grid;
}

class Chain {
  public:
    Chain(Random& random, std::ostream& out) : random_(random), out_(out), spheres_(drawSpheres(random)) {}

    void write() {
        const std::uint32_t frames = spheres_ > 10'000 ? 12 : 60;
        put(out_, spheres_);
        put(out_, frames);
        for (std::uint32_t k = 0; k < frames; ++k) give(k == 0 ? begin() : frame());
    }

  private:
    Positions positions() {
        if (draw(random_, 10) == 0) return wild(random_, spheres_);
        return positionsAt(motion_.next());
    }
    bool hashed() { return draw(random_, 4) == 0; }
    Bytes begin() {
        encoder_.frames().encodeKeyframe(encoder_.put(positions()), hashed());
        return last_ = encoder_.frames().download();
    }
    Bytes next() {
        encoder_.frames().encodeDelta(encoder_.put(positions()), hashed());
        return last_ = encoder_.frames().download();
    }
    Bytes join() {
        encoder_.frames().encodeResync(hashed());
        return last_ = encoder_.frames().download();
    }
    // Returns the next frame; if the chain is lost, soon a keyframe.
    Bytes frame() {
        const std::uint32_t kind = draw(random_, 32);
        if (decoder_.wantsKeyframe() ? kind < 16 : kind < 2) return join();
        if (kind == 17) return begin();
        if (kind == 18) (void)next();  // the decoder misses a frame
        if (kind < 26) return next();
        const Bytes other = last_;
        return garbled(random_, kind >= 29 ? join() : next(), other);
    }

    void give(const Bytes& bytes) {
        put(out_, bytes.size());
        put(out_, std::span(bytes));
        const auto head = decoder_.apply(bytes);
        put(out_, head ? 1 : 0);
        const std::string reason = head ? "" : head.error().text();
        put(out_, reason.size());
        put(out_, std::as_bytes(std::span(reason)));
        put(out_, std::as_bytes(decoder_.newest()));
        const bool two = head && !head->keyframe;
        put(out_, two ? 1 : 0);
        if (two) put(out_, std::as_bytes(decoder_.before()));
    }

    Random& random_;
    std::ostream& out_;
    std::uint32_t spheres_;
    Encoder encoder_{"cpu:1", spheres_, gridOf(random_)};
    Motion motion_{spheres_, random_()};
    codec::Decoder decoder_{spheres_};
    Bytes last_;
};

void write(std::uint64_t seed, const std::string& path) {
    constexpr int chains = 40;
    std::ofstream out(path, std::ios::binary);
    Random random(seed);
    for (int k = 0; k < chains; ++k) Chain(random, out).write();
    out.close();
    if (!out) throw std::runtime_error("cannot write to " + path);
}

}  // namespace
}  // namespace spherule::codec

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fputs("codec_chains SEED FILE\n", stderr);
        return 2;
    }
    try {
        spherule::codec::write(std::stoull(argv[1]), argv[2]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
