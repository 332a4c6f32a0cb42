#include "host/saved_scene.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

namespace spherule::host {

namespace {

constexpr std::size_t partSpheres = 256;  // about 40 KiB of text

std::string jsonOf(const google::protobuf::Message& message) {
    std::string text;
    const auto status = google::protobuf::util::MessageToJsonString(message, &text);
    return status.ok() ? text : "{}";
}

// Returns an object without its closing brace, ready for one more member.
std::string openEnded(std::string object) {
    object.pop_back();
    if (object.size() > 1) object += ",";
    return object;
}

}  // namespace

SavedScene::SavedScene(v1::Scene scene, std::vector<std::vector<std::uint32_t>> ranks, sim::State state,
                       glm::dvec3 centre, memory::Claim claim)
    : claim_(std::move(claim)),
      scene_(std::move(scene)),
      ranks_(std::move(ranks)),
      state_(std::move(state)),
      centre_(centre) {}

std::string SavedScene::beginOf(std::size_t group) const {
    return openEnded(jsonOf(scene_.groups(static_cast<int>(group)))) + "\"list\":{\"saved\":true,\"spheres\":[\n";
}

// The shortest decimal numbers from which the same binary ones are read.
void SavedScene::appendSphere(std::string& text, std::size_t rank) const {
    const glm::dvec3 place = glm::dvec3(state_.position[rank]) + centre_;
    const glm::vec4& v = state_.velocity[rank];
    const glm::vec4& spin = state_.spin[rank];
    const auto out = std::back_inserter(text);
    fmt::format_to(out, R"({{"position":[{},{},{}])", place.x, place.y, place.z);
    if (v.x != 0 || v.y != 0 || v.z != 0) fmt::format_to(out, R"(,"velocity":[{},{},{}])", v.x, v.y, v.z);
    if (spin.x != 0 || spin.y != 0 || spin.z != 0) fmt::format_to(out, R"(,"spin":[{},{},{}])", spin.x, spin.y, spin.z);
    fmt::format_to(out, R"(,"radius":{}}})", state_.position[rank].w);
}

std::string SavedScene::next() {
    std::string text;
    if (!begun_) {
        begun_ = true;
        v1::Scene head = scene_;
        head.clear_groups();
        text = openEnded(jsonOf(head)) + "\n\"groups\":[";
    }
    if (group_ == ranks_.size()) {
        if (!std::exchange(ended_, true)) text += "]}\n";
        return text;
    }
    const std::vector<std::uint32_t>& ranks = ranks_[group_];
    if (ranks.empty())
        text += (group_ > 0 ? ",\n" : "\n") + beginOf(group_) + "]}}";
    else if (done_ == 0)
        text += (group_ > 0 ? ",\n" : "\n") + beginOf(group_);
    for (const std::size_t end = std::min(done_ + partSpheres, ranks.size()); done_ < end; ++done_) {
        appendSphere(text, ranks[done_]);
        text += done_ + 1 < ranks.size() ? ",\n" : "\n]}}";
    }
    if (done_ == ranks.size()) {
        done_ = 0;
        ++group_;
    }
    return text;
}

}  // namespace spherule::host
