#include "scene/quality_goal.h"

#include "scene/check.h"

namespace spherule::scene {

namespace {

constexpr double mostStepTime = 60'000;  // ms

}  // namespace

Result<std::optional<QualityGoal>> qualityGoalOf(const v1::Auto& message, std::string_view where) {
    Check check;
    std::optional<QualityGoal> goal;
    if (message.goal_case() == v1::Auto::kBudgetMs)
        goal = {QualityGoal::Kind::StepTime,
                check.upTo(message.budget_ms(), mostStepTime, at(where, "budgetMs"), " ms")};
    if (message.goal_case() == v1::Auto::kOverlap)
        goal = {QualityGoal::Kind::Overlap, check.within(message.overlap(), 1e-6, 0.5, at(where, "overlap"))};
    if (!check.ok()) return check.error();
    return goal;
}

v1::Auto messageOf(const QualityGoal& goal) {
    v1::Auto message;
    if (goal.kind == QualityGoal::Kind::StepTime)
        message.set_budget_ms(goal.max);
    else
        message.set_overlap(goal.max);
    return message;
}

}  // namespace spherule::scene
