#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "scene/check.h"
#include "scene/field_rules.h"
#include "scene_support.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene::testing {
namespace {

namespace pb = google::protobuf;

// Scenes that the reader accepts. Together they have each message whose fields have a range.
const std::vector<std::string>& examples() {
    static const std::vector<std::string> all{
        R"({"bounds": {"min": [-9,-9,-9], "max": [9,9,9]}, "fields": [{"drag": {}},
            {"attraction": {"centre": [0,0,0], "strength": 1e-6, "softening": 1}}, {"buoyancy": {}},
            {"drag": {"vortex": {"centre": [0,0,0], "axis": [0,0,1], "core": 1}}}, {"spring": {"centre": [0,0,0]},
             "inSphere": {"centre": [0,0,0], "radius": 1}}],
            "materials": [{"name": "a"}, {"name": "b"}], "pairs": [{"a": "a", "b": "b"}], "quality": {"auto": {"budgetMs": 9}},
            "camera": {}, "sleep": {}, "light": {}, "sinks": [{"region": {"min": [0,0,0], "max": [1,1,1]}}],
            "groups": [{"list": {"spheres": [{"position": [0,0,8]}]}, "radius": {"constant": 0.1}},
                {"lattice": {"min": [1,1,1], "max": [2,2,2], "spacing": 0.5}, "radius": {"uniform": {"min": 0.1, "max": 0.2}}},
                {"fill": {"min": [5,5,5], "max": [6,6,6], "fraction": 0.1}, "radius": {"constant": 0.1}},
                {"fill": {"min": [3,3,3], "max": [4,4,4], "count": 1},
                 "radius": {"normal": {"mean": 0.1, "deviation": 0.01, "min": 0.05, "max": 0.15}}}],
            "emitters": [{"sphere": {"centre": [0,0,0], "radius": 1}, "rate": 1, "total": 1,
                 "radius": {"logNormal": {"median": 0.1, "deviation": 0.1, "min": 0.05, "max": 0.15}}},
                {"disc": {"centre": [0,0,0], "normal": [0,0,1], "radius": 1}, "massFlow": 1,
                 "schedule": [{"to": 2}], "repeat": 3,
                 "radius": {"table": {"radii": [0.1, 0.2], "shares": [0, 1]}}}]})",
        R"({"bounds": {"min": [-9,-9,-9], "max": [9,9,9]}, "quality": {"auto": {"overlap": 0.1}}, "obstacles": [
            {"plane": {"point": [0,0,-8], "normal": [0,0,1]}},
            {"box": {"min": [0,0,0], "max": [1,1,1]}, "rotation": {"axis": [0,0,1]}, "motion": {"velocity": [1,0,0],
                "duration": 1, "oscillations": [{"amplitude": [0,0,1], "frequency": 1}], "keyframes": [{"time": 1}]}},
            {"sphere": {"centre": [0,0,0], "radius": 1}, "motion": {"drive": {"along": [0,0,1], "mass": 1, "mostSpeed": 1}}},
            {"cylinder": {"from": [0,0,0], "to": [0,0,1], "radius": 1},
             "motion": {"drive": {"about": [0,0,1], "inertia": 1, "mostSpeed": 1}}},
            {"cone": {"from": [0,0,0], "to": [0,0,1], "fromRadius": 1, "toRadius": 1}},
            {"capsule": {"from": [0,0,0], "to": [0,0,1], "radius": 1}},
            {"disc": {"centre": [0,0,0], "normal": [0,0,1], "radius": 1}},
            {"heightField": {"heights": [0,0,0,0], "columns": 2, "min": [0,0,0], "max": [1,1,1]}},
            {"mesh": {"data": "diAwIDAgMAp2IDEgMCAwCnYgMCAxIDAKZiAxIDIgMwo="}}]})"};
    return all;
}

// Calls visit(message, its path) for the message and all messages in it.
template <class Visit>
void visitAll(pb::Message& message, const std::string& path, const Visit& visit) {
    visit(message, path);
    const pb::Reflection& reflection = *message.GetReflection();
    std::vector<const pb::FieldDescriptor*> given;
    reflection.ListFields(message, &given);
    for (const pb::FieldDescriptor* field : given) {
        if (field->message_type() == nullptr) continue;
        const std::string here = at(path, field->json_name());
        if (!field->is_repeated()) visitAll(*reflection.MutableMessage(&message, field), here, visit);
        for (int k = 0; field->is_repeated() && k < reflection.FieldSize(message, field); ++k)
            visitAll(*reflection.MutableRepeatedMessage(&message, field, k), at(here, static_cast<std::size_t>(k)),
                     visit);
    }
}

// Returns the path that build() refuses with this value; empty if it accepts the scene. Restores the message.
std::string refusedWith(const v1::Scene& scene, pb::Message& message, const pb::FieldDescriptor& field, double value) {
    const std::unique_ptr<pb::Message> before(message.New());
    before->CopyFrom(message);
    const pb::Reflection& reflection = *message.GetReflection();
    if (field.cpp_type() == pb::FieldDescriptor::CPPTYPE_DOUBLE)
        reflection.SetDouble(&message, &field, value);
    else if (field.cpp_type() == pb::FieldDescriptor::CPPTYPE_UINT64)
        reflection.SetUInt64(&message, &field, static_cast<std::uint64_t>(value));
    else
        reflection.SetUInt32(&message, &field, static_cast<std::uint32_t>(value));
    const auto built = build(scene);
    message.CopyFrom(*before);
    return built ? "" : built.error().where;
}

// Limits that another field narrows: they are not allowed in the examples.
bool isNarrowed(const std::string& field, double value) {
    static const std::map<std::string, double> narrowed{
        {"spherule.v1.Uniform.max", 1e-6},     {"spherule.v1.Normal.max", 1e-6},    {"spherule.v1.LogNormal.max", 1e-6},
        {"spherule.v1.Span.to", 1e9},          {"spherule.v1.Emitter.repeat", 1e9}, {"spherule.v1.DiscShape.hole", 1e9},
        {"spherule.v1.Quality.substeps", 1e6}, {"spherule.v1.Fill.fraction", 1}};
    const auto found = narrowed.find(field);
    return found != narrowed.end() && found->second == value;
}

class LimitsTest {
  public:
    LimitsTest(const v1::Scene& scene, pb::Message& message, const pb::FieldDescriptor& field, std::string path)
        : scene_(scene), message_(message), field_(field), path_(std::move(path)) {}

    void test() const {
        const v1::Rule& rule = ruleOf(field_);
        const bool whole = field_.cpp_type() != pb::FieldDescriptor::CPPTYPE_DOUBLE;
        constexpr double most = std::numeric_limits<double>::infinity();
        // A value of 0 means an absent one, unless the field has presence or is required.
        const bool zeroIsAbsent = !field_.has_presence() && !rule.required();
        if (rule.has_min() && !(whole && rule.min() == 0))
            expectRefused(whole ? rule.min() - 1 : std::nextafter(rule.min(), -most), zeroIsAbsent);
        if (rule.has_min()) expectAllowed(rule.min());
        if (rule.has_above()) expectRefused(zeroIsAbsent ? std::nextafter(rule.above(), -most) : rule.above(), false);
        if (rule.has_max()) expectRefused(whole ? rule.max() + 1 : std::nextafter(rule.max(), most), false);
        if (rule.has_max()) expectAllowed(rule.max());
    }

  private:
    void expectRefused(double value, bool zeroIsAbsent) const {
        if (value == 0 && zeroIsAbsent) return;
        EXPECT_EQ(refusedWith(scene_, message_, field_, value), path_) << value;
    }
    void expectAllowed(double value) const {
        if (isNarrowed(field_.full_name(), value)) return;
        EXPECT_NE(refusedWith(scene_, message_, field_, value), path_) << value;
    }

    const v1::Scene& scene_;
    pb::Message& message_;
    const pb::FieldDescriptor& field_;
    std::string path_;
};

TEST(FieldRules, EachFieldHasARuleAndAMeaning) {
    for (const pb::Descriptor* message : messagesOfScene())
        for (int k = 0; k < message->field_count(); ++k) {
            const pb::FieldDescriptor& field = *message->field(k);
            const v1::Rule& rule = ruleOf(field);
            EXPECT_TRUE(field.options().HasExtension(v1::rule)) << field.full_name();
            EXPECT_NE(meaningOf(field), "") << field.full_name();
            const bool oneOf = field.real_containing_oneof() != nullptr;
            EXPECT_TRUE(oneOf || rule.required() != !rule.absent().empty()) << field.full_name();
        }
}

TEST(FieldRules, RangesAreThoseOfTheReader) {
    std::set<std::string> tested;
    for (const std::string& json : examples()) {
        v1::Scene scene = parsed(json);
        const auto built = build(scene);
        ASSERT_TRUE(built) << built.error().text();
        visitAll(scene, "", [&](pb::Message& message, const std::string& path) {
            for (int k = 0; k < message.GetDescriptor()->field_count(); ++k) {
                const pb::FieldDescriptor& field = *message.GetDescriptor()->field(k);
                const v1::Rule& rule = ruleOf(field);
                const pb::OneofDescriptor* const oneof = field.real_containing_oneof();
                if (!rule.has_min() && !rule.has_max() && !rule.has_above()) continue;
                if (field.is_repeated()) continue;
                if (oneof != nullptr && message.GetReflection()->GetOneofFieldDescriptor(message, oneof) != &field)
                    continue;
                // A body that slides has no moment of inertia.
                if (field.full_name() == "spherule.v1.Drive.inertia" && path == "obstacles[2].motion.drive") continue;
                if (field.full_name() == "spherule.v1.Drive.force" && path == "obstacles[3].motion.drive") continue;
                if (field.full_name() == "spherule.v1.Drive.torque" && path == "obstacles[2].motion.drive") continue;
                LimitsTest(scene, message, field, at(path, field.json_name())).test();
                tested.insert(field.full_name());
            }
        });
    }
    for (const pb::Descriptor* message : messagesOfScene())
        for (int k = 0; k < message->field_count(); ++k) {
            const v1::Rule& rule = ruleOf(*message->field(k));
            const bool limited = rule.has_min() || rule.has_max() || rule.has_above();
            // Only scene files name files. A list of numbers has the limits of its entries.
            if (message->full_name() == "spherule.v1.Xyz" || message->full_name() == "spherule.v1.Lammps") continue;
            if (message->field(k)->is_repeated()) continue;
            EXPECT_TRUE(!limited || tested.contains(message->field(k)->full_name())) << message->field(k)->full_name();
        }
}

TEST(FieldRules, RequiredFieldsAreThoseOfTheReader) {
    for (const std::string& json : examples()) {
        v1::Scene scene = parsed(json);
        visitAll(scene, "", [&](pb::Message& message, const std::string& path) {
            for (int k = 0; k < message.GetDescriptor()->field_count(); ++k) {
                const pb::FieldDescriptor& field = *message.GetDescriptor()->field(k);
                if (!ruleOf(field).required()) continue;
                const std::unique_ptr<pb::Message> before(message.New());
                before->CopyFrom(message);
                message.GetReflection()->ClearField(&message, &field);
                const auto built = build(scene);
                message.CopyFrom(*before);
                EXPECT_FALSE(built) << at(path, field.json_name());
            }
        });
    }
}

TEST(FieldRules, EntriesAreLimitedAsByTheReader) {
    v1::Scene scene = parsed(examples()[1]);
    visitAll(scene, "", [&](pb::Message& message, const std::string& path) {
        const pb::Reflection& reflection = *message.GetReflection();
        for (int k = 0; k < message.GetDescriptor()->field_count(); ++k) {
            const pb::FieldDescriptor& field = *message.GetDescriptor()->field(k);
            if (!field.is_repeated() || field.message_type() == nullptr || ruleOf(field).most() == 0) continue;
            const std::unique_ptr<pb::Message> before(message.New());
            before->CopyFrom(message);
            while (reflection.FieldSize(message, &field) <= static_cast<int>(ruleOf(field).most()))
                (void)reflection.AddMessage(&message, &field);
            const auto built = build(scene);
            message.CopyFrom(*before);
            ASSERT_FALSE(built);
            EXPECT_EQ(built.error().where, at(path, field.json_name())) << built.error().text();
        }
    });
}

}  // namespace
}  // namespace spherule::scene::testing
