#include "recording_support.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "codec/order.h"
#include "codec_support.h"
#include "recording/record.h"

namespace spherule::recording {

namespace {

const glm::dvec3 low(-1, 0, 2), high(3, 8, 4);

void check(const Result<void>& done) {
    if (!done) throw std::runtime_error(done.error().text());
}

std::vector<std::uint32_t> orderOf(std::uint32_t spheres) {
    std::vector<std::uint32_t> ids(spheres);
    std::iota(ids.rbegin(), ids.rend(), 0U);
    return ids;
}

v1::ServerMessage frameMessage(std::uint32_t number, const codec::Bytes& bytes) {
    v1::ServerMessage message;
    v1::Frame& frame = *message.mutable_frame();
    frame.set_epoch(1);
    frame.set_step(6 * std::uint64_t{number});
    frame.set_sim_time(Film::interval * number);
    frame.set_count(Film::spheres);
    frame.set_order(1);
    frame.set_quantum(Film::quantum);
    frame.set_spb(bytes.data(), bytes.size());
    return message;
}

}  // namespace

v1::ServerMessage sceneMessage(std::uint32_t epoch, std::uint32_t spheres) {
    v1::ServerMessage message;
    v1::SceneFacts& facts = *message.mutable_scene();
    facts.set_epoch(epoch);
    facts.set_name("film");
    facts.set_count(spheres);
    for (int axis = 0; axis < 3; ++axis) {
        facts.add_bounds_min(low[axis]);
        facts.add_bounds_max(high[axis]);
    }
    std::vector<float> radii(spheres, 0.5F);
    radii.front() = 1.5F;
    facts.set_radii(radii.data(), radii.size() * sizeof(float));
    return message;
}

v1::ServerMessage orderMessage(std::uint32_t epoch, std::uint32_t spheres) {
    v1::ServerMessage message;
    *message.mutable_order() = codec::orderMessage(epoch, 1, orderOf(spheres));
    return message;
}

Film film(const std::string& path, std::uint32_t frames, bool finish, std::uint32_t fileId) {
    Film film;
    codec::Encoder encoder("cpu", Film::spheres, Film::quantum);
    encoder.setOrder(orderOf(Film::spheres));
    auto writer = Writer::create(path, false, fileId);
    if (!writer) throw std::runtime_error(writer.error().text());
    const auto add = [&](Kind kind, double time, const v1::ServerMessage& message) {
        const std::uint64_t at = writer->bytes();
        check(writer->add(kind, time, message.SerializeAsString()));
        film.records.push_back(recordBytes(kind, time, message.SerializeAsString(), {.id = fileId}, at));
    };
    add(Kind::Scene, 0, sceneMessage(1, Film::spheres));
    add(Kind::Order, 0, orderMessage(1, Film::spheres));
    for (std::uint32_t n = 0; n < frames; ++n) {
        codec::Positions positions(Film::spheres);
        const double phase = fileId - Film::fileId;
        for (std::uint32_t id = 0; id < Film::spheres; ++id)
            positions[id] = {std::sin(0.3 * n + id + phase), 0.1 * n * id, -0.01 * id * id, 0.5};
        const double time = Film::interval * n;
        add(n == 0 ? Kind::Keyframe : Kind::Delta, time,
            frameMessage(n, n == 0 ? encoder.begin(positions) : encoder.next(positions)));
        if (n > 0 && n % 5 == 0) add(Kind::Resync, time, frameMessage(n, encoder.join()));
        Positions expected;
        for (const auto& p : positions) expected.push_back(0.5 * (low + high) + glm::dvec3(p));
        film.frames.push_back(std::move(expected));
    }
    if (finish) {
        check(writer->finish());
    } else {
        std::string bytes = FileHead{.id = fileId}.bytes();
        for (const std::string& record : film.records) bytes += record;
        writeFile(path, bytes);
    }
    return film;
}

void filmWithRepeatedTimes(const std::string& path) {
    film(path, 10);
    const std::string whole = contentOf(path);
    std::string content = whole.substr(0, fileHeadBytes);
    for (const std::string& record : recordsOf(whole))
        if (kindOf(record) != Kind::Index)
            addRecord(content, kindOf(record), std::floor(5 * timeOf(record) + 0.01) / 5, payloadOf(record));
    writeFile(path, content);
}

v1::Pose poseInFilm(std::uint32_t n) {
    v1::Pose pose;
    pose.set_obstacle(1);
    for (const double part : {0.0, 0.25 * n, 0.0}) pose.add_translation(part);
    for (const double part : {0.0, 0.0, std::sin(0.05 * n), std::cos(0.05 * n)}) pose.add_rotation(part);
    return pose;
}

void filmWithObstacles(const std::string& path) {
    const Film plain = film(path, 12);
    const std::string whole = contentOf(path);
    std::string content = whole.substr(0, fileHeadBytes);
    for (const std::string& record : recordsOf(whole)) {
        if (kindOf(record) == Kind::Index) continue;
        v1::ServerMessage message;
        message.ParseFromString(std::string(payloadOf(record)));
        for (int k = 0; message.has_scene() && k < 2; ++k) {
            v1::Box& cube = *message.mutable_scene()->add_obstacles()->mutable_box();
            for (const double least : {2.0 * k, 1.0, 2.5}) {
                cube.add_min(least);
                cube.add_max(least + 1);
            }
        }
        if (message.has_frame())
            *message.mutable_frame()->add_poses() = poseInFilm(static_cast<std::uint32_t>(message.frame().step() / 6));
        addRecord(content, kindOf(record), timeOf(record), message.SerializeAsString());
    }
    writeFile(path, content);
}

std::string fileOf(std::string_view records) {
    std::string content = FileHead{.id = Film::fileId}.bytes();
    content += records;
    setChecksums(content);
    return content;
}

std::string contentOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void writeFile(const std::string& path, const std::string& content) {
    std::ofstream(path, std::ios::binary) << content;
}

std::vector<Positions> play(Recording& recording, std::string* end) {
    std::vector<Positions> frames;
    for (;;) {
        const auto more = recording.next();
        if (end != nullptr) *end = more ? "" : more.error().text();
        if (!more || !*more) return frames;
        const auto positions = recording.now().positions;
        frames.emplace_back(positions.begin(), positions.end());
    }
}

double distance(const Positions& a, const Positions& b) {
    if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
    double most = 0;
    for (std::size_t id = 0; id < a.size(); ++id)
        for (int axis = 0; axis < 3; ++axis) most = std::max(most, std::abs(a[id][axis] - b[id][axis]));
    return most;
}

}  // namespace spherule::recording
