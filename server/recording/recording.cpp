#include "recording/recording.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace spherule::recording {

namespace {

constexpr double sameTime = 1e-9;  // s; times that differ by less are equal
constexpr std::size_t mostSkippedEvents = 64;
constexpr int mostTries = 64;  // each may read another order

// Returns true when the message fits the kind of the record.
bool holds(Kind kind, const v1::ServerMessage& message) {
    if (kind == Kind::Scene) return message.has_scene();
    if (kind == Kind::Order) return message.has_order();
    if (kind == Kind::Settings) return message.has_settings();
    return kind == Kind::Other || message.has_frame();
}

// Returns true if frames with these turns may be of a scene with these periodic axes.
bool areOf(const glm::uvec3& turns, const glm::dvec3& periods) {
    for (int axis = 0; axis < 3; ++axis)
        if (turns[axis] > 0 && !(periods[axis] > 0)) return false;
    return true;
}

// Returns true if these are poses of some of the obstacles, in their order.
bool areOf(const google::protobuf::RepeatedPtrField<v1::Pose>& poses, int obstacles) {
    std::int64_t before = -1;
    const auto finite = [](double value) { return std::isfinite(value); };
    for (const v1::Pose& pose : poses) {
        if (pose.obstacle() <= before || std::int64_t{pose.obstacle()} >= obstacles) return false;
        if (pose.translation_size() != 3 || !std::ranges::all_of(pose.translation(), finite)) return false;
        const auto& turn = pose.rotation();
        constexpr double tolerance = 1e-6;
        const double length = std::inner_product(turn.begin(), turn.end(), turn.begin(), 0.0);
        if (turn.size() != 4 || !(std::abs(length - 1) < tolerance)) return false;
        before = pose.obstacle();
    }
    return true;
}

}  // namespace

Result<Recording> Recording::open(const std::string& path) {
    auto file = RecordFile::open(path);
    if (!file) return tl::unexpected(file.error());
    Recording recording(std::move(*file));
    recording.contents_ = contentsOf(recording.file_);
    const auto& entries = recording.contents_.index.entries;
    const auto first = std::ranges::find(entries, Kind::Keyframe, &Index::Entry::kind);
    if (recording.frames() == 0 || first == entries.end())
        return fail(ErrorKind::Input, path,
                    "has no frames" + (recording.damage().empty() ? "" : ": " + recording.damage()));
    // Read the first frame now, so that open() reports its errors.
    if (auto right = recording.startAt(first->offset); !right) return tl::unexpected(right.error());
    recording.dropDecoders();
    recording.offset_ = first->offset;
    return recording;
}

tl::unexpected<Error> Recording::bad(std::uint64_t offset, const std::string& what) const {
    return fail(ErrorKind::Input, file_.path(), fmt::format("the record at byte {} is damaged: {}", offset, what));
}

// Moves to the keyframe at this offset.
Result<void> Recording::startAt(std::uint64_t offset) {
    dropDecoders();
    table_.reset();
    order_.reset();
    skippedEvents_.clear();
    for (const Kind needed : {Kind::Scene, Kind::Order, Kind::Settings}) {
        const Index::Entry* newest = nullptr;
        for (const Index::Entry& entry : contents_.index.entries)
            if (entry.kind == needed && entry.offset < offset) newest = &entry;
        if (newest == nullptr && needed == Kind::Settings) continue;
        if (newest == nullptr) return bad(offset, "no scene or no order comes before this frame");
        const auto record = file_.read(newest->offset);
        if (!record) return tl::unexpected(record.error());
        if (record->kind != needed) return bad(newest->offset, "the index says that it is another");
        if (auto done = process(*record, newest->offset); !done) return tl::unexpected(done.error());
    }
    const auto record = file_.read(offset);
    if (!record) return tl::unexpected(record.error());
    if (record->kind != Kind::Keyframe && record->kind != Kind::Resync) return bad(offset, "is no keyframe");
    if (auto done = process(*record, offset); !done) return tl::unexpected(done.error());
    offset_ = record->end;
    return {};
}

Result<void> Recording::seek(double time) {
    const Index::Entry* from = nullptr;
    for (const Index::Entry& entry : contents_.index.entries) {
        if (entry.kind != Kind::Keyframe && entry.kind != Kind::Resync) continue;
        if (from == nullptr || entry.time <= time + sameTime) from = &entry;
    }
    if (from == nullptr) return fail(ErrorKind::Input, file_.path(), "has no keyframe");
    const bool forward = hasDecoders() && !decoders_[0]->wantsKeyframe() && time >= time_ && from->offset < offset_;
    if (!forward)
        if (auto done = startAt(from->offset); !done) return done;
    return advanceTo(time);
}

Result<void> Recording::advanceTo(double time) {
    for (;;) {
        const auto coming = nextTime();
        if (!coming) return tl::unexpected(coming.error());
        if (!*coming || **coming > time + sameTime) return {};
        if (auto done = next(); !done) return tl::unexpected(done.error());
    }
}

bool Recording::recover(double time) {
    int tries = 0;
    for (const Index::Entry& entry : contents_.index.entries) {
        const bool begins = entry.kind == Kind::Keyframe || entry.kind == Kind::Resync;
        if (!begins || entry.time <= time + sameTime) continue;
        if (startAt(entry.offset)) return true;
        if (++tries == mostTries) return false;
    }
    return false;
}

Result<std::optional<double>> Recording::nextTime() const {
    for (std::uint64_t offset = offset_; offset < contents_.end;) {
        const auto head = file_.readHead(offset);
        if (!head) return tl::unexpected(head.error());
        if (isFrame(head->kind)) return head->time;
        offset = head->end;
    }
    return std::nullopt;
}

Result<bool> Recording::next() {
    while (offset_ < contents_.end) {
        const auto record = file_.read(offset_);
        if (!record) return tl::unexpected(record.error());
        if (record->kind == Kind::Other) collectEvent(*record);
        // A resync repeats the previous frame.
        const Kind kind = record->kind;
        if (kind == Kind::Resync || kind == Kind::Other || kind == Kind::Index || kind == Kind::Log) {
            offset_ = record->end;
            continue;
        }
        auto frame = process(*record, offset_);
        if (!frame) return frame;
        offset_ = record->end;
        if (*frame) return true;
    }
    return false;
}

void Recording::collectEvent(const Record& record) {
    v1::ServerMessage message;
    if (!message.ParseFromString(record.payload) || !message.has_event()) return;
    if (skippedEvents_.size() == mostSkippedEvents) skippedEvents_.erase(skippedEvents_.begin());
    skippedEvents_.push_back(std::move(message));
}

// Returns true when the record is a frame.
Result<bool> Recording::process(const Record& record, std::uint64_t offset) {
    v1::ServerMessage message;
    if (!message.ParseFromString(record.payload)) return bad(offset, "it is no message");
    if (!holds(record.kind, message)) return bad(offset, "its message is of another kind");
    if (record.kind == Kind::Scene || record.kind == Kind::Order) {
        dropDecoders();
        table_.reset();
        if (record.kind == Kind::Scene) {
            facts_ = std::move(*message.mutable_scene());
            sceneOffset_ = offset;
        }
        if (record.kind == Kind::Order) order_ = std::move(*message.mutable_order());
        return false;
    }
    if (record.kind == Kind::Settings) {
        settings_ = std::move(*message.mutable_settings());
        return false;
    }
    if (auto done = decode(message.frame(), offset); !done) {
        dropDecoders();
        return tl::unexpected(done.error());
    }
    time_ = record.time;
    return true;
}

// Builds table_ and decoders_ for a new scene or order.
Result<void> Recording::ensureDecoders(std::uint64_t offset) {
    if (!table_) {
        if (!order_) return bad(offset, "no order comes before it");
        auto table = SphereTable::from(facts_, *order_);
        if (!table) return bad(offset, table.error().text());
        table_ = std::move(*table);
        order_.reset();
    }
    if (hasDecoders()) return {};
    for (auto& decoder : decoders_) decoder = std::make_unique<codec::Decoder>(table_->spheres());
    return {};
}

Result<void> Recording::decode(const v1::Frame& frame, std::uint64_t offset) {
    if (auto done = ensureDecoders(offset); !done) return done;
    if (frame.epoch() != table_->epoch || frame.order() != table_->order)
        return bad(offset, "its frame is of other spheres than scene and order before it");
    for (std::size_t column = 0; column < codec::columnCount; ++column) {
        const codec::EncodedColumn encoded = codec::columns[column].read(frame);
        if (!(encoded.quantum > 0) || !std::isfinite(encoded.quantum)) return bad(offset, "its frame has no quantum");
        const auto done = decoders_[column]->apply(std::as_bytes(std::span(encoded.spb)));
        if (!done) return bad(offset, done.error().text());
        if (!areOf(decoders_[column]->turns(), table_->periods))
            return bad(offset, "its frame has turns along an axis that is not periodic");
        quanta_[column] = encoded.quantum;
    }
    if (!areOf(frame.poses(), facts_.obstacles_size()))
        return bad(offset, "its frame has poses of other obstacles than the scene before it");
    poses_.assign(frame.poses().begin(), frame.poses().end());
    step_ = frame.step();
    return {};
}

// A periodic axis of the scene has quanta of its own.
glm::dvec3 Recording::quanta(std::size_t column) const {
    glm::dvec3 each(quanta_[column]);
    const glm::uvec3& turns = decoders_[column]->turns();
    for (int axis = 0; axis < 3; ++axis)
        if (turns[axis] > 0) each[axis] = table_->periods[axis] / turns[axis];
    return each;
}

Snapshot Recording::now() {
    static const SphereTable none;  // before the first frame
    if (table_ && hasDecoders()) {
        const glm::dvec3 centre = 0.5 * (table_->low + table_->high);
        const auto cells = decoders_[0]->newest();
        const glm::dvec3 each = quanta(0);
        positions_.resize(cells.size());
        for (std::size_t k = 0; k < cells.size(); ++k)
            positions_[table_->ids[k]] = centre + each * glm::dvec3(cells[k]);
    }
    return {.time = time_,
            .step = step_,
            .error = quanta_[0] / 2,
            .positions = positions_,
            .spheres = table_ ? &*table_ : &none,
            .scene = sceneOffset_,
            .facts = &facts_,
            .poses = poses_};
}

}  // namespace spherule::recording
