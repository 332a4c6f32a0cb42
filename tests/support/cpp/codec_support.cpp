#include "codec_support.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "value_of.h"

namespace spherule::codec {

namespace {

using support::valueOf;

constexpr double edge = 1073741824;

}  // namespace

Encoder::Encoder(const std::string& device, std::uint32_t spheres, double quantum, glm::vec3 origin)
    : Encoder(device, spheres, encode::ColumnEncoder::Grid{.origin = origin, .quantum = quantum}) {}

Encoder::Encoder(const std::string& device, std::uint32_t spheres, const encode::ColumnEncoder::Grid& grid)
    : device_(valueOf(compute::openDevice(device))),
      context_(valueOf(encode::EncoderContext::create(*device_, spheres, true))),
      encoder_(valueOf(encode::ColumnEncoder::create(*context_, grid))),
      position_(valueOf(device_->createBuffer("position", spheres * sizeof(glm::vec4), "r"))),
      slotOf_(valueOf(device_->createBuffer("slotOf", spheres * sizeof(std::uint32_t)))),
      slots_(spheres) {
    std::iota(slots_.begin(), slots_.end(), 0U);
    std::ranges::shuffle(slots_, std::mt19937(7));
    device_->upload(*slotOf_, 0, std::as_bytes(std::span(slots_)));
}

encode::ColumnSource Encoder::put(const Positions& byId) {
    Positions bySlot(byId.size());
    for (std::size_t id = 0; id < byId.size(); ++id) bySlot[slots_[id]] = byId[id];
    device_->upload(*position_, 0, std::as_bytes(std::span(bySlot)));
    return {.values = position_.get(), .slotOf = slotOf_.get()};
}

Bytes Encoder::begin(const Positions& byId) {
    encoder_->encodeKeyframe(put(byId), true);
    return encoder_->download();
}

Bytes Encoder::next(const Positions& byId) {
    encoder_->encodeDelta(put(byId), true);
    return encoder_->download();
}

Bytes Encoder::join() {
    encoder_->encodeResync(true);
    return encoder_->download();
}

glm::ivec3 onGrid(glm::vec4 position, double quantum, glm::vec3 origin) {
    glm::ivec3 cell{};
    for (int axis = 0; axis < 3; ++axis) {
        const float x = position[axis];
        const float scaled = (x - origin[axis]) * static_cast<float>(1 / quantum);
        const double place = std::isnan(x) ? -edge : std::floor(static_cast<double>(scaled + 0.5F));
        cell[axis] = static_cast<int>(std::clamp(place, -edge, edge));
    }
    return cell;
}

std::vector<glm::ivec3> onGrid(const Positions& positions) {
    std::vector<glm::ivec3> cells;
    for (const glm::vec4& p : positions) cells.push_back(onGrid(p));
    return cells;
}

Positions positionsAt(const std::vector<glm::ivec3>& cells) {
    Positions positions;
    for (const glm::ivec3& q : cells) positions.emplace_back(q, 1);
    return positions;
}

Motion::Motion(std::uint32_t spheres, std::uint64_t seed) : random_(seed), cells_(spheres), steps_(spheres) {
    for (auto& cell : cells_) cell = draw(2000, 2000, 2000) - 1000;
    for (auto& step : steps_) step = draw(41, 41, 41) - 20;
}

std::uint32_t Motion::draw(std::uint32_t below) {
    random_ = random_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::uint32_t>((random_ >> 33U) % below);
}

glm::ivec3 Motion::draw(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    glm::ivec3 drawn;
    drawn.x = static_cast<int>(draw(x));
    drawn.y = static_cast<int>(draw(y));
    drawn.z = static_cast<int>(draw(z));
    return drawn;
}

const std::vector<glm::ivec3>& Motion::next() {
    ++frame_;
    for (std::uint32_t k = 0; k < cells_.size(); ++k) {
        glm::ivec3& q = cells_[k];
        const std::uint32_t block = k / 64;
        switch (block % 8) {
            case 0:  // rests, except for rare jumps
                if ((frame_ + block / 8) % 5 == 0) q += 1000;
                break;
            case 1:  // creeps, one sphere of ten
                if (draw(10) == 0) q += draw(3, 3, 3) - 1;
                break;
            case 2:  // flies, all with the same acceleration
                steps_[k].z -= 17;
                q += steps_[k] + draw(3, 3, 3) - 1;
                break;
            case 3:  // slows down
                for (int axis = 0; axis < 3; ++axis) steps_[k][axis] = steps_[k][axis] >> 1;
                q += steps_[k];
                if (frame_ % 6 == 0) steps_[k] = draw(4001, 4001, 4001) - 2000;
                break;
            case 4: {  // jitters, in each run by something else
                const std::uint32_t reach = 1U << ((k / 8 + frame_) % 13);
                q = draw(2 * reach, 2 * reach, 2 * reach) - static_cast<int>(reach);
                break;
            }
            case 5: {  // jumps as far as a float holds whole numbers
                const std::uint32_t reach = 1U << (10 + (block / 8 + frame_) % 14);
                q = draw(2 * reach, 2 * reach, 2 * reach) - static_cast<int>(reach);
                break;
            }
            case 6:  // moves with a velocity common to all
                q += glm::ivec3(300, -5000, 70) + draw(2, 2, 2);
                if (q.y < -10000000) q.y = 0;
                break;
            default:
                q += draw(9, 3U << 2 * (block / 8 % 8), 1) - glm::ivec3(4, 2, 0);
        }
    }
    return cells_;
}

}  // namespace spherule::codec
