#include "sphere_file.h"

#include <gtest/gtest.h>

namespace spherule::scene::testing {

Result<Scene> SphereFile::loaded(const std::string& text, const std::string& options,
                                 const std::string& members) const {
    (void)folder_.write(name_, text);
    return load(folder_.write("scene.json", R"({"bounds": {"min": [-1000, -1000, -1000], "max": [1000, 1000, 1000]},
        "groups": [{")" + source_ + R"(": {"file": ")" +
                                                name_ + '"' + options + "}" + members + "}]}"),
                "software");
}

std::vector<Sphere> SphereFile::spheres(const std::string& text, const std::string& options,
                                        const std::string& members) const {
    auto scene = loaded(text, options, members);
    if (scene) return std::move(scene->spheres);
    ADD_FAILURE() << scene.error().text() << "\n" << text;
    return {};
}

std::string SphereFile::refusal(const std::string& text, const std::string& options, const std::string& members) const {
    const auto scene = loaded(text, options, members);
    if (scene) return "accepted";
    const std::string reason = scene.error().text();
    const std::size_t file = reason.find(name_ + ":");
    return reason.substr(file == std::string::npos ? reason.find("groups[0]") : file);
}

std::vector<Sphere> randomSpheres(Random& random) {
    std::vector<Sphere> spheres(static_cast<std::size_t>(random.uniform(0, 30)));
    const auto component = [&](double most) { return random.uniform(-most, most); };
    for (Sphere& sphere : spheres) {
        sphere.position = {component(900), component(900), component(900)};
        sphere.velocity = {component(50), component(50), component(50)};
        sphere.spin = {component(9), component(9), component(9)};
        sphere.radius = static_cast<float>(random.uniform(1.5, 90));
    }
    return spheres;
}

void expectEqual(const std::vector<Sphere>& read, const std::vector<Sphere>& expected) {
    ASSERT_EQ(read.size(), expected.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(read[i].position[axis], expected[i].position[axis], 1e-11) << i;
            EXPECT_FLOAT_EQ(read[i].velocity[axis], expected[i].velocity[axis]) << i;
            EXPECT_FLOAT_EQ(read[i].spin[axis], expected[i].spin[axis]) << i;
        }
        EXPECT_FLOAT_EQ(read[i].radius, expected[i].radius) << i;
    }
}

}  // namespace spherule::scene::testing
