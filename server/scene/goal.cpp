#include "scene/goal.h"

#include "scene/check.h"

namespace spherule::scene {

namespace {

constexpr double mostStepTime = 60'000;  // ms

}  // namespace

Result<std::optional<Goal>> goalOf(const v1::Auto& message, std::string_view where) {
    Check check;
    std::optional<Goal> goal;
    if (message.goal_case() == v1::Auto::kBudgetMs)
        goal = {Goal::Of::StepTime, check.upTo(message.budget_ms(), mostStepTime, at(where, "budgetMs"), " ms")};
    if (message.goal_case() == v1::Auto::kOverlap)
        goal = {Goal::Of::Overlap, check.within(message.overlap(), 1e-6, 0.5, at(where, "overlap"))};
    if (!check.ok()) return check.error();
    return goal;
}

v1::Auto messageOf(const Goal& goal) {
    v1::Auto message;
    if (goal.of == Goal::Of::StepTime)
        message.set_budget_ms(goal.most);
    else
        message.set_overlap(goal.most);
    return message;
}

}  // namespace spherule::scene
