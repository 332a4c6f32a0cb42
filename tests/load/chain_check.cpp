#include "chain_check.h"

#include <cstddef>
#include <span>

#include <spdlog/fmt/fmt.h>

namespace spherule::load {

namespace {

constexpr std::size_t idBytes = 3;

std::span<const std::byte> bytesOf(const std::string& text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace

void Received::operator+=(const Received& other) {
    frames += other.frames;
    keyframes += other.keyframes;
    losses += other.losses;
    missed += other.missed;
    ignored += other.ignored;
    hashes += other.hashes;
    chains += other.chains;
}

std::optional<std::string> ChainCheck::take(const v1::ServerMessage& message) {
    if (message.has_welcome() == welcomed_) return welcomed_ ? "a second welcome" : "a message before the welcome";
    welcomed_ = true;
    switch (message.kind_case()) {
        case v1::ServerMessage::kScene:
            return scene(message.scene());
        case v1::ServerMessage::kOrder:
            return order(message.order());
        case v1::ServerMessage::kStream:
            // A new chain starts with a keyframe.
            stream_ = message.stream();
            chain_.reset();
            return std::nullopt;
        case v1::ServerMessage::kFrame:
            return frame(message.frame());
        case v1::ServerMessage::KIND_NOT_SET:
            return "a message of no known kind";
        default:
            return std::nullopt;
    }
}

std::optional<std::string> ChainCheck::scene(const v1::SceneFacts& facts) {
    if (epoch_ && facts.epoch() <= *epoch_) return fmt::format("facts of epoch {} after {}", facts.epoch(), *epoch_);
    epoch_ = facts.epoch();
    spheres_ = facts.count();
    order_.reset();
    chain_.reset();
    decoder_.reset();
    return std::nullopt;
}

std::optional<std::string> ChainCheck::order(const v1::Order& order) {
    // An order of another epoch belongs to no frame that may come now.
    if (epoch_ != order.epoch()) return std::nullopt;
    if (order.ids().size() != idBytes * spheres_)
        return fmt::format("an order of {} bytes for {} spheres", order.ids().size(), spheres_);
    std::vector<bool> seen(spheres_);
    for (std::size_t at = 0; at < order.ids().size(); at += idBytes) {
        std::uint32_t id = 0;
        for (std::size_t byte = idBytes; byte-- > 0;)
            id = id << 8U | static_cast<unsigned char>(order.ids()[at + byte]);
        if (id >= spheres_ || seen[id]) return fmt::format("an order that is no permutation: id {}", id);
        seen[id] = true;
    }
    order_ = order.number();
    return std::nullopt;
}

std::optional<std::string> ChainCheck::frame(const v1::Frame& frame) {
    if (epoch_ && frame.epoch() < *epoch_) {
        ++received_.ignored;
        return std::nullopt;
    }
    if (auto fault = described(frame)) return fault;
    if (frame.sequence() <= sequence_) return fmt::format("sequence {} after {}", frame.sequence(), sequence_);
    sequence_ = frame.sequence();
    const auto head = codec::headOf(bytesOf(frame.spb()));
    if (!head) return head.error().text();
    if (auto fault = follows(frame, *head)) return fault;
    ++received_.frames;
    if (!decode_) return std::nullopt;
    if (!decoder_) decoder_.emplace(spheres_);
    if (const auto decoded = decoder_->apply(bytesOf(frame.spb())); !decoded) return decoded.error().text();
    if (head->hash) ++received_.hashes;
    return std::nullopt;
}

std::optional<std::string> ChainCheck::described(const v1::Frame& frame) const {
    if (epoch_ != frame.epoch()) return fmt::format("a frame of epoch {} before its facts", frame.epoch());
    if (order_ != frame.order()) return fmt::format("a frame of order {} before that order", frame.order());
    if (frame.count() != spheres_)
        return fmt::format("a frame of {} spheres where there are {}", frame.count(), spheres_);
    if (!stream_ || stream_->rate() == 0) return "a frame where the stream has none";
    if (frame.tier() != stream_->tier())
        return fmt::format("a frame of tier {} on a stream of {}", v1::Tier_Name(frame.tier()),
                           v1::Tier_Name(stream_->tier()));
    if (!(frame.quantum() > 0)) return "a frame without a quantum";
    if (frame.stamp_us() == 0) return "a frame without a stamp";
    return std::nullopt;
}

std::optional<std::string> ChainCheck::follows(const v1::Frame& frame, const codec::FrameHead& head) {
    if (head.spheres != spheres_)
        return fmt::format("{} spheres in the codec where there are {}", head.spheres, spheres_);
    if (head.keyframe) {
        ++received_.keyframes;
        if (!chain_) {
            ++received_.chains;
        } else {
            ++received_.losses;
            if (head.number <= chain_->number)
                return fmt::format("a keyframe of number {} after {}", head.number, chain_->number);
            received_.missed += head.number - chain_->number - 1;
        }
    } else {
        if (!chain_) return fmt::format("delta frame {} before a keyframe of its chain", head.number);
        if (head.number != chain_->number + 1)
            return fmt::format("delta frame {} after {}", head.number, chain_->number);
        if (frame.quantum() != chain_->quantum) return "another quantum within a chain";
    }
    chain_ = Chain{.epoch = frame.epoch(), .tier = frame.tier(), .quantum = frame.quantum(), .number = head.number};
    return std::nullopt;
}

}  // namespace spherule::load
