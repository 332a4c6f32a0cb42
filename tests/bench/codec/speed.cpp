#include "speed.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

#include <spdlog/fmt/fmt.h>

#include "codec/decoder.h"
#include "encode/column_encoder.h"
#include "encode/morton.h"
#include "value_of.h"

namespace spherule::bench {

namespace {

constexpr double kickedRadius = 0.016;  // m, the smallest
constexpr float spacing = 0.04F;        // m
constexpr int rounds = 15;

using support::valueOf;

template <class Work>
double milliseconds(compute::Device& device, Work&& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    device.finish();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

void write(const std::string& folder, const std::string& name, std::span<const std::byte> bytes) {
    if (folder.empty()) return;
    std::ofstream file(folder + "/" + name, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!file) throw std::runtime_error("cannot write to " + folder);
}

double median(std::vector<double> values) {
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
}

// Positions by slot (m), and the slot of each id.
struct World {
    explicit World(std::uint32_t spheres) : bySlot(spheres), slotOf(spheres) {}
    virtual ~World() = default;
    World(const World&) = delete;
    World& operator=(const World&) = delete;
    virtual void move() = 0;  // to the next frame

    std::vector<glm::vec4> bySlot;
    std::vector<std::uint32_t> slotOf;
};

// A cube of spheres. Slots are in the order of grid cells, slice by slice. Ids number a lattice row by row, or are
// shuffled.
struct Kicked : World {
    Kicked(std::uint32_t spheres, bool shuffled) : World(spheres), velocity(spheres) {
        const auto side = static_cast<std::uint32_t>(std::ceil(std::cbrt(spheres)));
        std::uniform_real_distribution<float> jitter(-0.3F * spacing, 0.3F * spacing);
        std::uniform_real_distribution<float> speed(-0.01F, 0.01F);  // m per frame
        std::vector<std::pair<std::uint64_t, std::uint32_t>> cells(spheres);
        for (std::uint32_t id = 0; id < spheres; ++id) {
            const std::uint64_t x = id % side, y = id / side % side, z = id / (side * side);
            cells[id] = {(y * side + z) * side + x, id};
        }
        std::ranges::sort(cells);
        for (std::uint32_t slot = 0; slot < spheres; ++slot) {
            const std::uint32_t id = cells[slot].second;
            slotOf[id] = slot;
            bySlot[slot] = glm::vec4(id % side, id / side % side, id / (side * side), 0) * spacing;
            bySlot[slot] += glm::vec4(jitter(random), jitter(random), jitter(random), 0.016F);
            velocity[slot] = glm::vec4(speed(random), speed(random), speed(random), 0);
        }
        if (shuffled) std::ranges::shuffle(slotOf, random);
    }

    // All spheres fall, and change their velocities at random, about as much as in a splash.
    void move() override {
        std::normal_distribution<float> kick(0, 0.0025F);
        std::vector<float> kicks(4099);
        for (float& one : kicks) one = kick(random);
        std::size_t next = random() % kicks.size();
        const auto draw = [&] { return kicks[next = (next + 1) % kicks.size()]; };
        for (std::size_t k = 0; k < bySlot.size(); ++k) {
            velocity[k] += glm::vec4(draw(), draw(), draw() - 0.0109F, 0);
            if (velocity[k].z < -0.15F) velocity[k].z += 0.3F;
            bySlot[k] += velocity[k];
        }
    }

    std::mt19937 random{1};
    std::vector<glm::vec4> velocity;
};

// Copies of a simulated bed side by side. Slots are in Morton order.
struct Copies : World {
    Copies(std::uint32_t spheres, const Trajectory& bed) : World(spheres), bed_(bed) {
        std::iota(slotOf.begin(), slotOf.end(), 0U);
        place(0);
        const std::vector<std::uint32_t> order = encode::mortonOrder(bySlot);
        for (std::uint32_t slot = 0; slot < spheres; ++slot) slotOf[order[slot]] = slot;
        place(0);
    }
    void move() override { place(++frame_); }

  private:
    void place(std::size_t frame) {
        constexpr std::uint32_t row = 5;
        constexpr float apart = 1.7F;  // m
        const auto& positions = bed_.frames.at(frame);
        for (std::uint32_t id = 0; id < slotOf.size(); ++id) {
            const std::uint32_t copy = id / bed_.spheres;
            const glm::vec3 corner = apart * glm::vec3(copy % row, copy / row, 0);
            bySlot[slotOf[id]] = glm::vec4(positions[id % bed_.spheres] + corner, 0);
        }
    }

    const Trajectory& bed_;
    std::size_t frame_ = 0;
};

CodecSpeed timed(compute::Device& device, World& world, double quantum, const std::string& keep) {
    const auto spheres = static_cast<std::uint32_t>(world.slotOf.size());
    const auto context = valueOf(encode::EncoderContext::create(device, spheres, true));
    const auto frames = valueOf(encode::ColumnEncoder::create(*context, {.quantum = quantum}));
    const auto position = valueOf(device.createBuffer("position", spheres * sizeof(glm::vec4), "r"));
    const auto slotOf = valueOf(device.createBuffer("slotOf", spheres * sizeof(std::uint32_t)));
    device.upload(*slotOf, 0, std::as_bytes(std::span(world.slotOf)));
    std::vector<glm::vec4> byId(spheres);
    for (std::uint32_t id = 0; id < spheres; ++id) byId[id] = world.bySlot[world.slotOf[id]];
    const std::vector<std::uint32_t> order = encode::mortonOrder(byId);
    context->setOrder(order);
    write(keep, "order.u32", std::as_bytes(std::span(order)));
    const encode::ColumnSource source{.values = position.get(), .slotOf = slotOf.get()};
    const auto put = [&] { device.upload(*position, 0, std::as_bytes(std::span(world.bySlot))); };

    put();
    frames->encodeKeyframe(source);
    codec::Decoder decoder(spheres);
    const auto keyframeMade = frames->download();
    (void)valueOf(decoder.apply(keyframeMade));
    write(keep, "frame-0.spb", keyframeMade);
    std::vector<double> encode, keyframe, hash, decode;
    CodecSpeed speed;
    for (int round = 0; round < rounds; ++round) {
        world.move();
        put();
        const bool hashed = round % 3 == 2;
        (hashed ? hash : encode).push_back(milliseconds(device, [&] { frames->encodeDelta(source, hashed); }));
        const auto frame = frames->download();
        write(keep, fmt::format("frame-{}.spb", round + 1), frame);
        const double took = milliseconds(device, [&] { (void)valueOf(decoder.apply(frame)); });
        if (!hashed) decode.push_back(took);
        speed.bytes = static_cast<double>(frame.size()) / spheres;
    }
    for (int round = 0; round < 5; ++round) keyframe.push_back(milliseconds(device, [&] { frames->encodeResync(); }));
    speed.fastest = std::ranges::min(encode);
    speed.encode = median(encode);
    speed.keyframe = median(keyframe);
    speed.hash = median(hash) - speed.encode;
    speed.decode = median(decode);
    return speed;
}

}  // namespace

CodecSpeed codecSpeed(compute::Device& device, std::uint32_t spheres, double ratio, bool shuffled,
                      const std::string& keep) {
    Kicked world(spheres, shuffled);
    return timed(device, world, 2 * kickedRadius / ratio, keep);
}

CodecSpeed codecSpeed(compute::Device& device, std::uint32_t spheres, double ratio, const Trajectory& bed,
                      const std::string& keep) {
    Copies world(spheres, bed);
    return timed(device, world, 2 * bed.smallestRadius / ratio, keep);
}

}  // namespace spherule::bench
