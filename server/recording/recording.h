#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "codec/decoder.h"
#include "core/result.h"
#include "recording/index.h"
#include "recording/sphere_table.h"
#include "spherule/v1/control.pb.h"

namespace spherule::recording {

// Where the spheres were at one time. Holds until the recording is moved to another.
struct Snapshot {
    double time = 0;  // s simulated
    std::uint64_t step = 0;
    double error = 0;                       // m; positions are those of the simulation to within this, on each axis
    std::span<const glm::dvec3> positions;  // by id, m
    std::span<const float> radii;           // by id, m
    glm::dvec3 low{}, high{};               // bounds of the scene, m
};

// A recording to be played; the file may be cut off or hostile. Used by one thread. It takes memory for its index, its
// spheres and one frame.
class Recording {
  public:
    // Input for what cannot be played, and why.
    static Result<Recording> open(const std::string& path);

    [[nodiscard]] const v1::SceneFacts& facts() const { return facts_; }      // of the newest snapshot
    [[nodiscard]] const v1::Settings& settings() const { return settings_; }  // likewise
    [[nodiscard]] std::uint64_t frames() const { return contents_.index.frames; }
    [[nodiscard]] double begin() const { return contents_.index.begin; }  // s simulated: of the first frame
    [[nodiscard]] double end() const { return contents_.index.end; }      // of the last one
    // Why it ends before the end of the file, or has none that was meant; empty: nothing is wrong with it.
    [[nodiscard]] const std::string& damage() const { return contents_.damage; }

    // To the last frame that is not after `time` (s), or to the first one.
    Result<void> seek(double time);
    // To the next frame, after open() the first; false at the end. After an error only seek() and recover() go on.
    Result<bool> next();
    // To the first sound keyframe after `time` (s), for going on behind what is damaged; false when there is none, or
    // only behind very many that are damaged too.
    bool recover(double time);

    // After next(), seek() or recover(), until the next of them.
    [[nodiscard]] Snapshot now();
    [[nodiscard]] double time() const { return time_; }  // s simulated
    [[nodiscard]] std::uint64_t step() const { return step_; }
    // When the frame after it comes, s simulated; nothing at the end.
    [[nodiscard]] Result<std::optional<double>> nextTime() const;
    // Whether there is a snapshot; not after an error that came before the first frame behind a keyframe.
    [[nodiscard]] bool shows() const { return table_ && decoder_ && !decoder_->wantsKeyframe(); }
    // Where in the file the present facts are; elsewhere are those of other spheres, whatever epoch they name.
    [[nodiscard]] std::uint64_t sceneOffset() const { return sceneOffset_; }
    [[nodiscard]] std::span<const glm::ivec3> cells() const { return decoder_->newest(); }  // by place in the codec
    [[nodiscard]] std::span<const std::uint32_t> order() const { return table_->ids; }  // ids, by place in the codec
    [[nodiscard]] std::span<const float> radii() const { return table_->radii; }        // by id, m
    [[nodiscard]] double quantum() const { return quantum_; }                           // m

    // Events that next() and a seek() forward went past, newest last, since they were last taken; of very many, the
    // newest.
    std::vector<v1::ServerMessage> takeSkippedEvents() { return std::exchange(skippedEvents_, {}); }

  private:
    explicit Recording(RecordFile file) : file_(std::move(file)) {}

    Result<void> enter(std::uint64_t offset);
    Result<void> walk(double time);
    void pass(const Record& record);
    Result<bool> take(const Record& record, std::uint64_t offset);
    Result<void> show(const v1::Frame& frame, std::uint64_t offset);
    Result<void> prepare(std::uint64_t offset);
    [[nodiscard]] tl::unexpected<Error> bad(std::uint64_t offset, const std::string& what) const;

    RecordFile file_;
    Contents contents_;
    std::uint64_t offset_ = fileHeadBytes;  // of what comes next
    v1::SceneFacts facts_;
    std::uint64_t sceneOffset_ = 0;   // byte of the file
    std::optional<v1::Order> order_;  // until the table is made of it
    std::optional<SphereTable> table_;
    std::unique_ptr<codec::Decoder> decoder_;
    double time_ = 0;
    std::uint64_t step_ = 0;
    double quantum_ = 0;
    std::vector<glm::dvec3> positions_;  // when somebody asks
    v1::Settings settings_;
    std::vector<v1::ServerMessage> skippedEvents_;
};

}  // namespace spherule::recording
