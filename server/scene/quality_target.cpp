#include "scene/quality_target.h"

#include "scene/check.h"

namespace spherule::scene {

namespace {

constexpr double mostStepTime = 60'000;  // ms

}  // namespace

Result<std::optional<QualityTarget>> qualityTargetOf(const v1::Auto& message, std::string_view where) {
    Check check;
    std::optional<QualityTarget> target;
    if (message.goal_case() == v1::Auto::kBudgetMs)
        target = {QualityTarget::Kind::StepTime,
                  check.upTo(message.budget_ms(), mostStepTime, at(where, "budgetMs"), " ms")};
    if (message.goal_case() == v1::Auto::kOverlap)
        target = {QualityTarget::Kind::Overlap, check.within(message.overlap(), 1e-6, 0.5, at(where, "overlap"))};
    if (!check.ok()) return check.error();
    return target;
}

v1::Auto messageOf(const QualityTarget& target) {
    v1::Auto message;
    if (target.kind == QualityTarget::Kind::StepTime)
        message.set_budget_ms(target.max);
    else
        message.set_overlap(target.max);
    return message;
}

}  // namespace spherule::scene
