#include <gtest/gtest.h>

#include "methods.h"
#include "recipe.h"
#include "test_device.h"

namespace spherule::bench {
namespace {

// A box whose spheres have fallen for half a second and press on each other.
class Contacts : public testing::Test {
  protected:
    void SetUp() override {
        device_ = support::openTestDevice();
        simulation_ = sim::Simulation::create(*device_, box(2000).value()).value();
        for (int step = 0; step < 30; ++step) ASSERT_TRUE(simulation_->step());
        state_ = simulation_->snapshot();
    }

    std::uint64_t contactsOf(Result<std::unique_ptr<Baseline>> method) {
        if (!method) throw std::runtime_error(method.error().text());
        (*method)->upload(state_);
        (*method)->substep();
        return (*method)->contacts();
    }

    // Number of contacts, computed on the host from the definition.
    [[nodiscard]] std::uint64_t expected() const {
        std::uint64_t contacts = 0;
        for (std::uint32_t a = 0; a < state_.count(); ++a) {
            for (std::uint32_t b = 0; b < a; ++b) {
                const glm::vec3 d = glm::vec3(state_.position[a]) - glm::vec3(state_.position[b]);
                const float reach = 2 * simulation_->scene().spheres.front().radius;
                if (d.x * d.x + d.y * d.y + d.z * d.z < reach * reach) ++contacts;
            }
        }
        return contacts;
    }

    [[nodiscard]] Setting setting() { return settingFor(*device_, *simulation_, true); }

    std::unique_ptr<compute::Device> device_;
    std::unique_ptr<sim::Simulation> simulation_;
    sim::State state_;
};

TEST_F(Contacts, EveryBroadPhaseMatchesBruteForce) {
    const std::uint64_t all = contactsOf(bruteForce(setting()));
    EXPECT_EQ(all, expected());
    EXPECT_GT(all, 2000U);
    EXPECT_EQ(contactsOf(slotsGrid(setting(), studentGrid(setting()))), all);
    EXPECT_EQ(contactsOf(slotsGrid(setting(), fineGrid(setting(), 1))), all);
    EXPECT_EQ(contactsOf(slotsGrid(setting(), fineGrid(setting(), 64))), all);
    EXPECT_EQ(contactsOf(sweepAndPrune(setting())), all);
}

TEST_F(Contacts, SubstepsStartFromThePreviousState) {
    auto brute = bruteForce(setting()).value();
    auto sweep = sweepAndPrune(setting()).value();
    auto grid = slotsGrid(setting(), fineGrid(setting(), 64)).value();
    for (Baseline* method : {brute.get(), sweep.get(), grid.get()}) {
        method->upload(state_);
        for (int k = 0; k < 6; ++k) method->substep();
    }
    // The methods add floats in different orders, so rounding may decide whether a pair just touches.
    const auto all = static_cast<double>(brute->contacts());
    EXPECT_GT(all, 6.0 * 2000);
    EXPECT_NEAR(static_cast<double>(sweep->contacts()), all, 0.002 * all);
    EXPECT_NEAR(static_cast<double>(grid->contacts()), all, 0.002 * all);
}

TEST_F(Contacts, SpheresWithoutASlotAreCounted) {
    auto method = slotsGrid(setting(), {.cells = glm::uvec3(1), .slots = 1900, .localSize = 64}).value();
    method->upload(state_);
    method->substep();
    EXPECT_EQ(method->overflowed(), 100U);
    EXPECT_EQ(method->note(), "100 spheres per substep found their cell full");
}

TEST_F(Contacts, TooLargeGridIsRefusedWithItsSize) {
    auto method = slotsGrid(setting(), {.cells = glm::uvec3(512), .slots = 4096, .localSize = 1});
    ASSERT_FALSE(method.has_value());
    EXPECT_EQ(method.error().kind, ErrorKind::Refused);
    EXPECT_NE(method.error().text().find("MiB"), std::string::npos) << method.error().text();
}

TEST(MeanOverlap, IsTheMeanOverPairsThatOverlap) {
    const std::vector<glm::vec4> positions = {{0, 0, 0, 1}, {1.5, 0, 0, 1}, {9, 0, 0, 1}, {9, 1.9, 0, 1}, {9, 0, 2, 1}};
    EXPECT_NEAR(meanOverlap(positions), 0.3, 1e-6);
}

TEST(Arrangements, LieInTheBoxWithSmallOverlaps) {
    const scene::Scene scene = box(3000).value();
    const sim::State state = arranged(scene, dense);
    const glm::vec3 half = 0.5F * glm::vec3(scene.bounds.max - scene.bounds.min);
    for (const glm::vec4& sphere : state.position) {
        for (int axis = 0; axis < 3; ++axis)
            ASSERT_LE(std::abs(sphere[axis]) + sphere.w, half[axis] + 0.02F * sphere.w);
    }
    EXPECT_GT(meanOverlap(state.position), 0);
    EXPECT_LT(meanOverlap(state.position), 0.02);
    EXPECT_EQ(meanOverlap(arranged(scene, falling).position), 0);
}

}  // namespace
}  // namespace spherule::bench
