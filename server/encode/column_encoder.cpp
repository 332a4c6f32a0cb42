#include "encode/column_encoder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string_view>

#include <fmt/format.h>

#include "codec/format.h"
#include "compute/check.h"
#include "sim/layout.h"
#include "sim/shaders.h"

namespace spherule::encode {

namespace {

constexpr std::size_t word = 4;

static_assert(CODEC_VALUE_SHIFT == codec::valueShift && CODEC_SPIN_SHIFT == codec::spinShift);
static_assert(CODEC_LENGTHS == v1::SPEED && CODEC_FIGURES == v1::CONTACTS && v1::OVERLAP == v1::CONTACTS + 1 &&
              v1::ENERGY == v1::CONTACTS + 2);

constexpr std::array kernelFiles =
    std::to_array<std::string_view>({"codec_choose.comp", "codec_sum.comp", "scan_reduce.comp", "scan_top.comp",
                                     "scan_spread.comp", "codec_layout.comp", "codec_place.comp", "codec_hash.comp"});

std::uint32_t over(std::uint32_t values, std::uint32_t per) {
    return values / per + (values % per != 0 ? 1 : 0);
}

std::uint32_t wordAt(std::span<const std::byte> bytes, std::size_t index) {
    std::uint32_t value = 0;
    std::memcpy(&value, &bytes[word * index], sizeof value);
    return value;
}

struct Counts {
    std::uint32_t blocks, groups, chunks;
    explicit Counts(std::uint32_t spheres)
        : blocks(over(spheres, CODEC_BLOCK)), groups(over(blocks, CODEC_GROUP)), chunks(over(groups, CODEC_CHUNK)) {}
    [[nodiscard]] std::size_t frameWords() const {
        return CODEC_TURNS_HEAD + chunks + groups * (1 + CODEC_GROUP * std::size_t{CODEC_MOST_WORDS});
    }
};

}  // namespace

EncoderBytes encoderBytes(std::uint32_t spheres) {
    const Counts counts(spheres);
    const std::uint64_t n = spheres;
    const std::uint64_t blocks = counts.blocks;
    constexpr std::uint64_t idBytes = 3;      // of an order
    constexpr std::uint64_t jsonBytes = 8;    // of an order for viewers that read JSON, and of its encoded copy
    constexpr std::uint64_t frameBytes = 6;   // about, per sphere of a keyframe
    constexpr std::uint64_t frameCopies = 6;  // read-back, bytes, message, encoded message; of two frames
    return {.contextArrays = word * (n + blocks * (CODEC_PACKED + CODEC_SCRATCH) + counts.groups),
            .order = n * (word + 2 * idBytes + jsonBytes),
            .encoderArrays = word * (2 * blocks * CODEC_VALUES + counts.frameWords()),
            .frames = n * frameBytes * frameCopies};
}

struct EncoderContext::Kernels {
    std::array<std::unique_ptr<compute::Kernel>, KernelCount> all;
};

EncoderContext::EncoderContext(compute::Device& device, std::uint32_t spheres)
    : device_(device),
      spheres_(spheres),
      blocks_(Counts(spheres).blocks),
      groups_(Counts(spheres).groups),
      chunks_(Counts(spheres).chunks) {}

Result<std::unique_ptr<EncoderContext>> EncoderContext::create(compute::Device& device, std::uint32_t spheres,
                                                               bool slots, std::shared_ptr<Kernels> kernels) {
    const EncoderBytes sizes = encoderBytes(spheres);
    const std::uint64_t arrays = device.hostBytes(sizes.contextArrays);
    auto claim = memory::Claim::make("", fmt::format("the order of {} spheres", spheres), arrays + sizes.order);
    if (!claim) return tl::unexpected(claim.error());
    std::unique_ptr<EncoderContext> context(new EncoderContext(device, spheres));
    context->claim_ = std::move(*claim);
    const std::array defines = {compute::Define{"CONTACTS", slots ? "true" : "false"}};
    context->kernels_ = kernels ? std::move(kernels) : std::make_shared<Kernels>();
    for (std::size_t k = 0; k < KernelCount && !context->kernels_->all[k]; ++k) {
        auto kernel = device.createKernel(sim::shaders(), kernelFiles[k], defines);
        if (!kernel) return fail(ErrorKind::NoDevice, kernel.error().where, kernel.error().message);
        context->kernels_->all[k] = std::move(*kernel);
    }
    struct Wanted {
        std::unique_ptr<compute::Buffer>& buffer;
        std::string_view label;
        std::size_t words;
        std::string_view kinds = "u";
    };
    const std::size_t blocks = context->blocks_;
    const std::string parameterWords = sim::layout::wordsOf("Parameters", "codec_layout.h");
    for (const Wanted& wanted :
         {Wanted{context->order_, "codec order", spheres},
          Wanted{context->blockWords_, "codec blocks", blocks * CODEC_PACKED},
          Wanted{context->scratch_, "codec scratch", blocks * CODEC_SCRATCH},
          Wanted{context->groupWords_, "codec groups", context->groups_},
          Wanted{context->sums_, "codec sums", over(context->groups_, SCAN_BLOCK)},
          Wanted{context->parameters_, "codec parameters", parameterWords.size(), parameterWords}}) {
        auto made = device.createBuffer(wanted.label, word * wanted.words, wanted.kinds);
        if (!made) return tl::unexpected(made.error());
        wanted.buffer = std::move(*made);
    }
    std::vector<std::uint32_t> ids(spheres);
    std::iota(ids.begin(), ids.end(), 0U);
    context->setOrder(ids);
    context->claim_.settle(arrays, sizes.order);
    return context;
}

void EncoderContext::setOrder(std::span<const std::uint32_t> order) {
    device_.upload(*order_, 0, std::as_bytes(order));
}

void EncoderContext::run(Kernel kernel, std::initializer_list<Binding> bindings, std::uint32_t count,
                         std::uint32_t phase) {
    const compute::Kernel& code = *kernels_->all[kernel];
    std::array<compute::Buffer*, compute::maxKernelBuffers> bound{};
    std::size_t slot = 0;
    for (const auto& declared : code.buffers()) {
        const auto* const found = std::ranges::find(bindings, declared.name, &Binding::name);
        if (found == bindings.end())
            compute::programError(fmt::format("{} is launched without its buffer {}", code.name(), declared.name));
        bound[slot++] = found->buffer;
    }
    device_.launch({.kernel = &code,
                    .buffers = std::span(bound.data(), slot),
                    .parameters = parameters_.get(),
                    .phase = phase,
                    .count = count});
}

Result<std::unique_ptr<ColumnEncoder>> ColumnEncoder::create(EncoderContext& context, const Grid& grid) {
    const EncoderBytes sizes = encoderBytes(context.spheres_);
    const std::uint64_t arrays = context.device_.hostBytes(sizes.encoderArrays);
    auto claim = memory::Claim::make("", fmt::format("frames of {} spheres", context.spheres_), arrays + sizes.frames);
    if (!claim) return tl::unexpected(claim.error());
    std::unique_ptr<ColumnEncoder> encoder(new ColumnEncoder(context, grid));
    encoder->claim_ = std::move(*claim);
    const std::size_t blocks = context.blocks_;
    const std::size_t frameWords = Counts(context.spheres_).frameWords();
    for (auto& [buffer, words] :
         {std::pair(&encoder->newest_, blocks * CODEC_VALUES), std::pair(&encoder->before_, blocks * CODEC_VALUES),
          std::pair(&encoder->frame_, frameWords)}) {
        auto made = context.device_.createBuffer("codec encoder", word * words);
        if (!made) return tl::unexpected(made.error());
        *buffer = std::move(*made);
    }
    encoder->claim_.settle(arrays, sizes.frames);
    return encoder;
}

void ColumnEncoder::encodeKeyframe(const ColumnSource& source, bool hash) {
    encode(Kind::Keyframe, source, hash);
}

void ColumnEncoder::encodeDelta(const ColumnSource& source, bool hash) {
    encode(Kind::Delta, source, hash);
}

void ColumnEncoder::encodeResync(bool hash) {
    encode(Kind::Resync, {.values = context_.order_.get(), .slotOf = context_.order_.get()}, hash);
}

void ColumnEncoder::encode(Kind kind, const ColumnSource& source, bool hash) {
    copy_.reset();
    copied_ = 0;
    keyframe_ = kind != Kind::Delta;
    if (kind != Kind::Resync) ++number_;
    const bool previousOnly = still_;
    still_ = keyframe_;

    codec_layout::Parameters parameters{};
    parameters.origin = glm::vec4(grid_.origin, 0);
    parameters.period = glm::vec4(glm::vec3(grid_.periods), 0);
    parameters.turns = glm::uvec4(turns(), 0U);
    for (int axis = 0; axis < 3; ++axis) {
        const double turns = parameters.turns[axis];
        parameters.perQuantum[axis] = static_cast<float>(turns > 0 ? turns / grid_.periods[axis] : 1 / grid_.quantum);
    }
    parameters.head = headWords();
    parameters.quantity = grid_.spins ? CODEC_SPINS : static_cast<std::uint32_t>(grid_.quantity);
    parameters.spheres = context_.spheres_;
    parameters.blocks = context_.blocks_;
    parameters.groups = context_.groups_;
    parameters.chunks = context_.chunks_;
    parameters.number = number_;
    parameters.flags = (keyframe_ ? CODEC_KEYFRAME : 0U) | (hash ? CODEC_HASHED : 0U) |
                       (headWords() == CODEC_TURNS_HEAD ? CODEC_TURNS : 0U);
    parameters.predictors = 1U << CODEC_PREVIOUS;
    if (keyframe_)
        parameters.predictors = 1U << CODEC_NONE;
    else if (!previousOnly)
        parameters.predictors |= 1U << CODEC_LINEAR | 1U << CODEC_HALF;
    parameters.fromState = kind == Kind::Resync ? 1 : 0;
    context_.device_.upload(*context_.parameters_, 0, std::as_bytes(std::span(&parameters, 1)));

    using enum EncoderContext::Kernel;
    compute::Buffer* const slotOf = source.slotOf == nullptr ? context_.order_.get() : source.slotOf;
    const std::uint32_t sums = over(context_.groups_, SCAN_BLOCK);
    context_.run(Choose,
                 {{"source", source.values},
                  {"slotOf", slotOf},
                  {"order", context_.order_.get()},
                  {"newest", newest_.get()},
                  {"before", before_.get()},
                  {"blockWords", context_.blockWords_.get()},
                  {"scratch", context_.scratch_.get()}},
                 context_.blocks_);
    if (kind != Kind::Resync) std::swap(newest_, before_);
    compute::Buffer* const groupWords = context_.groupWords_.get();
    compute::Buffer* const scratch = context_.scratch_.get();
    compute::Buffer* const frame = frame_.get();
    context_.run(Sum, {{"scratch", scratch}, {"groupWords", groupWords}}, context_.groups_);
    context_.run(Reduce, {{"values", groupWords}, {"sums", context_.sums_.get()}}, sums, context_.groups_);
    context_.run(Top, {{"sums", context_.sums_.get()}}, 1, sums);
    context_.run(Spread, {{"values", groupWords}, {"sums", context_.sums_.get()}}, sums, context_.groups_);
    context_.run(Layout, {{"scratch", scratch}, {"groupStart", groupWords}, {"frame", frame}}, context_.groups_);
    context_.run(Place, {{"blockWords", context_.blockWords_.get()}, {"scratch", scratch}, {"frame", frame}},
                 context_.blocks_);
    if (hash) context_.run(Hash, {{"newest", newest_.get()}, {"frame", frame}}, context_.blocks_);
}

// Quanta that are no wider than the grid's, so that the error is no larger.
glm::uvec3 ColumnEncoder::turns() const {
    glm::uvec3 counts(0U);
    for (int axis = 0; axis < 3 && grid_.turns; ++axis)
        counts[axis] = static_cast<std::uint32_t>(std::ceil(grid_.periods[axis] / grid_.quantum));
    return counts;
}

std::uint32_t ColumnEncoder::headWords() const {
    return turns() == glm::uvec3(0U) ? CODEC_FRAME_HEAD : CODEC_TURNS_HEAD;
}

std::size_t ColumnEncoder::headBytes() const {
    return word * (headWords() + context_.chunks_);
}

std::size_t ColumnEncoder::bytesOf(std::span<const std::byte> head) const {
    return headBytes() + word * wordAt(head, headWords() + context_.chunks_ - 1);
}

// Copies the head first, because it contains the length of the frame.
std::optional<std::vector<std::byte>> ColumnEncoder::poll() {
    for (;;) {
        if (!copy_) {
            copied_ = std::max(copied_, headBytes());
            copy_ = context_.device_.startReadBack(*frame_, copied_);
            if (!copy_) return std::nullopt;
        }
        const auto arrived = copy_->poll();
        if (!arrived) return std::nullopt;
        const std::size_t bytes = bytesOf(*arrived);
        if (bytes <= copied_) {
            std::vector<std::byte> frame(arrived->begin(), arrived->begin() + static_cast<std::ptrdiff_t>(bytes));
            copy_.reset();
            copied_ = 0;
            return frame;
        }
        copy_.reset();
        copied_ = bytes;
    }
}

std::vector<std::byte> ColumnEncoder::download() {
    std::vector<std::byte> frame(headBytes());
    context_.device_.download(*frame_, 0, frame);
    frame.resize(bytesOf(frame));
    context_.device_.download(*frame_, headBytes(), std::span(frame).subspan(headBytes()));
    return frame;
}

}  // namespace spherule::encode
