#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "codec/columns.h"
#include "codec/decoder.h"
#include "core/result.h"
#include "recording/index.h"
#include "recording/sphere_table.h"
#include "spherule/v1/control.pb.h"

namespace spherule::recording {

// Positions at one time. Valid until the recording moves to another frame.
struct Snapshot {
    double time = 0;  // s simulated
    std::uint64_t step = 0;
    double error = 0;                                                   // largest error of a coordinate, m
    std::span<const glm::dvec3> positions;                              // by id, m
    const SphereTable* spheres = nullptr;                               // not null after Recording::now()
    std::uint64_t scene = 0;                                            // differs between scenes of a recording
    const v1::SceneFacts* facts = &v1::SceneFacts::default_instance();  // of the scene
    std::span<const v1::Pose> poses{};                                  // of the obstacles that move
};

// Plays a recording. The file may be cut off or hostile. Used by one thread. Allocates memory for the index, the
// spheres and one frame.
class Recording {
  public:
    // Input if the file cannot be played.
    static Result<Recording> open(const std::string& path);

    [[nodiscard]] const v1::SceneFacts& facts() const { return facts_; }      // of the current frame
    [[nodiscard]] const v1::Settings& settings() const { return settings_; }  // of the current frame
    [[nodiscard]] std::uint64_t frames() const { return contents_.index.frames; }
    [[nodiscard]] double begin() const { return contents_.index.begin; }  // time of the first frame (s)
    [[nodiscard]] double end() const { return contents_.index.end; }      // time of the last frame (s)
    // Why the recording is incomplete; empty if it is complete.
    [[nodiscard]] const std::string& damage() const { return contents_.damage; }

    // Moves to the last frame that is not after `time` (s), or to the first frame.
    Result<void> seek(double time);
    // Moves to the next frame; after open(), to the first. Returns false at the end. After an error only seek() and
    // recover() may be called.
    Result<bool> next();
    // Moves to the first readable keyframe after `time` (s), to skip damaged records. Returns false if there is none
    // among the next 64 keyframes.
    bool recover(double time);

    // Call after next(), seek() or recover(); valid until the next such call.
    [[nodiscard]] Snapshot now();
    [[nodiscard]] double time() const { return time_; }  // s simulated
    [[nodiscard]] std::uint64_t step() const { return step_; }
    // Time of the next frame (s); nullopt at the end.
    [[nodiscard]] Result<std::optional<double>> nextTime() const;
    // Returns true when now() has positions. False after an error, until a keyframe has been read.
    [[nodiscard]] bool shows() const { return table_ && hasDecoders() && !decoders_[0]->wantsKeyframe(); }
    // Offset in the file of the current scene facts. Another offset means another scene, even with the same epoch.
    [[nodiscard]] std::uint64_t sceneOffset() const { return sceneOffset_; }
    // The values of a column (see codec/columns.h): quanta(column) * cells(column), in codec order.
    [[nodiscard]] std::span<const glm::ivec3> cells(std::size_t column) const { return decoders_[column]->newest(); }
    [[nodiscard]] glm::dvec3 quanta(std::size_t column) const;  // per axis
    // The poses of the obstacles that move: each of another obstacle of facts(), and with finite numbers.
    [[nodiscard]] std::span<const v1::Pose> poses() const { return poses_; }
    // Returns the length of each periodic axis (m); 0 along the others.
    [[nodiscard]] const glm::dvec3& periods() const { return table_->periods; }
    [[nodiscard]] std::span<const std::uint32_t> order() const { return table_->ids; }  // ids, in codec order
    [[nodiscard]] std::span<const float> radii() const { return table_->radii; }        // by id, m

    // Returns and clears the events that next() and seek() skipped since the last call, newest last; at most 64.
    std::vector<v1::ServerMessage> takeSkippedEvents() { return std::exchange(skippedEvents_, {}); }

  private:
    explicit Recording(RecordFile file) : file_(std::move(file)) {}

    Result<void> startAt(std::uint64_t offset);
    Result<void> advanceTo(double time);
    void collectEvent(const Record& record);
    Result<bool> process(const Record& record, std::uint64_t offset);
    Result<void> decode(const v1::Frame& frame, std::uint64_t offset);
    Result<void> ensureDecoders(std::uint64_t offset);
    void dropDecoders() { decoders_ = {}; }
    [[nodiscard]] bool hasDecoders() const { return decoders_[0] != nullptr; }
    [[nodiscard]] tl::unexpected<Error> bad(std::uint64_t offset, const std::string& what) const;

    RecordFile file_;
    Contents contents_;
    std::uint64_t offset_ = fileHeadBytes;  // of the next record
    v1::SceneFacts facts_;
    std::uint64_t sceneOffset_ = 0;   // bytes
    std::optional<v1::Order> order_;  // until table_ is built from it
    std::optional<SphereTable> table_;
    codec::PerColumn<std::unique_ptr<codec::Decoder>> decoders_;  // all or none
    double time_ = 0;
    std::uint64_t step_ = 0;
    codec::PerColumn<double> quanta_{};
    std::vector<glm::dvec3> positions_;  // filled by now()
    std::vector<v1::Pose> poses_;
    v1::Settings settings_;
    std::vector<v1::ServerMessage> skippedEvents_;
};

}  // namespace spherule::recording
