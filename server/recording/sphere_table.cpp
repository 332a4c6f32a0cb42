#include "recording/sphere_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "codec/order.h"

namespace spherule::recording {

namespace {

tl::unexpected<Error> bad(const char* what) {
    return fail(ErrorKind::Input, "scene facts", what);
}

// Returns false when `from` is not a finite position.
bool set(glm::dvec3& target, const google::protobuf::RepeatedField<double>& from) {
    if (from.size() != 3) return false;
    for (int axis = 0; axis < 3; ++axis) {
        target[axis] = from[axis];
        if (!std::isfinite(from[axis])) return false;
    }
    return true;
}

// Groups that do not fit the spheres set nothing.
void setGroups(SphereTable& table, const v1::SceneFacts& facts) {
    table.groups.assign(facts.count(), -1);
    table.materials.assign(facts.count(), -1);
    const auto set = [&](std::uint32_t first, std::uint32_t count, std::uint32_t group) {
        if (first > facts.count() || count > facts.count() - first) return;
        if (group >= static_cast<std::uint32_t>(facts.groups_size())) return;
        const v1::GroupFacts& from = facts.groups(static_cast<int>(group));
        std::fill_n(table.groups.begin() + first, count, static_cast<std::int32_t>(group));
        if (from.has_material())
            std::fill_n(table.materials.begin() + first, count, static_cast<std::int32_t>(from.material()));
    };
    for (const v1::Places& places : facts.places()) set(places.first(), places.count(), places.group());
    if (!facts.places().empty()) return;
    for (int k = 0; k < facts.groups_size(); ++k)
        set(facts.groups(k).first(), facts.groups(k).count(), static_cast<std::uint32_t>(k));
}

}  // namespace

std::vector<ExportedColumn> SphereTable::exportedColumns() const {
    return {
        {"group", std::span(groups)},
        {"material", std::span(materials)},
    };
}

Result<SphereTable> SphereTable::from(const v1::SceneFacts& facts, const v1::Order& order) {
    SphereTable table{
        .epoch = facts.epoch(), .radii = {}, .groups = {}, .materials = {}, .order = order.number(), .ids = {}};
    if (order.epoch() != facts.epoch()) return bad("are of another epoch than the order");
    if (!set(table.low, facts.bounds_min()) || !set(table.high, facts.bounds_max())) return bad("have no bounds");
    for (int axis = 0; axis < 3; ++axis)
        if (table.low[axis] > table.high[axis]) return bad("have no bounds");
    for (const int each : facts.periodic()) {
        const int axis = each - v1::X;
        if (axis < 0 || axis > 2) return bad("have a periodic axis that is none");
        table.periods[axis] = table.high[axis] - table.low[axis];
        if (!(table.periods[axis] > 0)) return bad("have a periodic axis without length");
    }
    if (facts.count() == 0) return bad("have no spheres");
    auto ids = codec::idsOf(order, facts.count());
    if (!ids) return tl::unexpected(ids.error());
    table.ids = std::move(*ids);
    table.radii.assign(facts.count(), facts.radius());
    if (!(facts.radius() > 0)) {
        if (facts.radii().size() != table.radii.size() * sizeof(float)) return bad("have radii of other spheres");
        std::memcpy(table.radii.data(), facts.radii().data(), facts.radii().size());
    }
    if (!std::ranges::all_of(table.radii, [](float radius) { return radius > 0 && std::isfinite(radius); }))
        return bad("have a radius that is none");
    setGroups(table, facts);
    return table;
}

}  // namespace spherule::recording
