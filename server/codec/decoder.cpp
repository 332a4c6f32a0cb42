#include "codec/decoder.h"

#include <algorithm>
#include <cstring>

#include "codec/block.h"
#include "codec/format.h"

namespace spherule::codec {

namespace {

tl::unexpected<Error> bad(const std::string& where, std::string message) {
    return fail(ErrorKind::Input, "frame" + (where.empty() ? "" : ", " + where), std::move(message));
}

std::string blockName(std::uint32_t block) {
    return "block " + std::to_string(block);
}

// Returns the defect of a block, apart from its size; nullptr if there is none.
const char* fault(const Block& block, bool keyframe, unsigned history) {
    const bool alone = block.predictor() == Predictor::None;
    if (alone != keyframe) return keyframe ? "is predicted in a keyframe" : "is not predicted in a delta frame";
    if (alone && block.mode() != Mode::RunsWithBase) return "has no base";
    if (!keyframe && block.predictor() != Predictor::Previous && history < 2)
        return "is predicted from a velocity right after a keyframe";
    return nullptr;
}

}  // namespace

Result<FrameHead> headOf(std::span<const std::byte> frame) {
    std::array<std::uint32_t, headWords> words{};
    if (frame.size() < sizeof words) return bad("head", "has " + std::to_string(frame.size()) + " bytes of 16");
    std::memcpy(words.data(), frame.data(), sizeof words);
    if ((words[0] & ~(keyframeFlag | hashedFlag | turnsFlag)) != magic)
        return bad("head", "is not a head of codec SPB, version 1");
    if (words[1] == 0) return bad("head", "has no spheres");
    FrameHead head{.spheres = words[1], .number = words[2], .keyframe = (words[0] & keyframeFlag) != 0, .hash = {}};
    if ((words[0] & hashedFlag) != 0) head.hash = words[3];
    if ((words[0] & turnsFlag) == 0) return head;
    if (frame.size() < sizeof(std::uint32_t) * turnsHeadWords)
        return bad("head", "has " + std::to_string(frame.size()) + " bytes of 28");
    std::memcpy(&head.turns, frame.data() + sizeof words, sizeof head.turns);
    for (int axis = 0; axis < 3; ++axis)
        if (head.turns[axis] > mostTurns || head.turns[axis] == 1)
            return bad("head", "has " + std::to_string(head.turns[axis]) + " turns");
    if (head.turns == glm::uvec3(0U)) return bad("head", "has no turns");
    return head;
}

std::size_t FrameHead::words() const {
    return turns == glm::uvec3(0U) ? headWords : turnsHeadWords;
}

std::uint32_t hashOf(std::span<const glm::ivec3> positions) {
    std::uint32_t sum = 0;
    std::uint32_t k = 0;
    for (const glm::ivec3& q : positions) {
        std::uint32_t h = (static_cast<std::uint32_t>(q.x) + k++ * 0x9e3779b1U) * 0x85ebca77U;
        h ^= h >> 15U;
        h = (h + static_cast<std::uint32_t>(q.y)) * 0xc2b2ae3dU;
        h ^= h >> 13U;
        h = (h + static_cast<std::uint32_t>(q.z)) * 0x27d4eb2fU;
        h ^= h >> 16U;
        sum += h;
    }
    return sum;
}

Decoder::Decoder(std::uint32_t spheres)
    : spheres_(spheres), newest_(std::size_t{blocksFor(spheres)} * blockSpheres), before_(newest_.size()) {}

Result<FrameHead> Decoder::apply(std::span<const std::byte> frame) {
    const unsigned history = history_;
    history_ = 0;
    auto head = headOf(frame);
    if (!head) return head;
    history_ = history;
    if (auto follows = checkOrder(*head); !follows) {
        history_ = 0;
        return tl::unexpected(follows.error());
    }
    const std::size_t words = frame.size() / sizeof(std::uint32_t);
    if (words_.size() < words + 2) words_.resize(words + 2);
    std::memcpy(words_.data(), frame.data(), words * sizeof(std::uint32_t));
    if (auto done = frame.size() % 4 != 0 ? bad("end", "is no whole word") : decode(*head, words); !done) {
        history_ = 0;
        return tl::unexpected(done.error());
    }
    std::swap(newest_, before_);
    number_ = head->number;
    turns_ = head->turns;
    history_ = head->keyframe ? 1 : 2;
    if (head->hash && *head->hash != hashOf(newest())) {
        history_ = 0;
        return bad("head", "has another hash than its positions");
    }
    return head;
}

Result<void> Decoder::checkOrder(const FrameHead& head) const {
    if (head.spheres != spheres_) {
        return bad("head",
                   "has " + std::to_string(head.spheres) + " spheres where there are " + std::to_string(spheres_));
    }
    if (head.keyframe) return {};
    if (history_ != 0 && head.turns != turns_) return bad("head", "has other turns than the frame before");
    if (history_ == 0) return bad("head", "is no keyframe, and none came before");
    if (head.number != number_ + 1) {
        return bad("head",
                   "is number " + std::to_string(head.number) + ", which does not follow " + std::to_string(number_));
    }
    return {};
}

Result<void> Decoder::decode(const FrameHead& head, std::size_t words) {
    const std::uint32_t chunks = chunksFor(spheres_);
    const std::size_t start = head.words() + chunks;
    if (words < start) return bad("table", "goes beyond the end");
    std::size_t begin = start;
    for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) {
        const std::size_t end = start + words_[head.words() + chunk];
        if (end < begin || end > words) return bad("chunk " + std::to_string(chunk), "ends outside of the frame");
        if (auto done = decodeChunk(head, chunk, begin, end); !done) return done;
        begin = end;
    }
    if (begin != words) return bad("end", "differs from the end of the last chunk");
    return {};
}

Result<void> Decoder::decodeChunk(const FrameHead& head, std::uint32_t chunk, std::size_t begin, std::size_t end) {
    const std::span<const std::uint32_t> words(words_.data(), end);
    const std::uint32_t blocks = blocksFor(spheres_);
    const std::uint32_t last = std::min(blocks, (chunk + 1) * chunkBlocks);
    std::size_t word = begin;
    for (std::uint32_t first = chunk * chunkBlocks; first < last; first += groupBlocks) {
        if (word >= end) return bad("group of " + blockName(first), "goes beyond its chunk");
        const std::uint32_t bitmap = words[word];
        std::size_t unit = 2 * (word + 1);
        const std::uint32_t count = std::min(groupBlocks, last - first);
        if (count < groupBlocks && bitmap >> count != 0)
            return bad("group of " + blockName(first), "has blocks that do not exist");
        for (std::uint32_t k = 0; k < count; ++k) {
            const std::size_t at = std::size_t{first + k} * blockSpheres;
            if ((bitmap >> k & 1U) == 0) {
                if (head.keyframe) return bad(blockName(first + k), "is missing in a keyframe");
                std::copy_n(&newest_[at], blockSpheres, &before_[at]);
                continue;
            }
            Block block;
            if (!block.read(words, unit, 2 * end)) return bad(blockName(first + k), "goes beyond its chunk");
            if (const char* const what = fault(block, head.keyframe, history_)) return bad(blockName(first + k), what);
            block.decode(words_.data(), head.turns, &newest_[at], &before_[at]);
            unit = block.end();
        }
        word = (unit + 1) / 2;
    }
    if (word != end) return bad("chunk " + std::to_string(chunk), "does not end where its groups do");
    return {};
}

}  // namespace spherule::codec
