#pragma once

#include <string>
#include <vector>

#include "measure/bench.h"

namespace spherule::measure {

// A case builds scenes, runs them and adds figures. An error is reported after the figures that it has added.
struct Case {
    std::string suite;
    std::string name;
    Result<void> (*run)(Bench& bench) = nullptr;
    bool everyRung = true;   // false: only with the substeps that the model chooses
    bool everyModel = true;  // false: only `accurate`
    bool whenQuick = true;
};

std::vector<Case> flightCases();
std::vector<Case> impactCases();
std::vector<Case> hertzCases();
std::vector<Case> frictionCases();
std::vector<Case> chainCases();
std::vector<Case> gasCases();
std::vector<Case> restCases();
std::vector<Case> reposeCases();
std::vector<Case> extremeCases();
std::vector<Case> settingCases();
std::vector<Case> commandCases();
std::vector<Case> crowdCases();  // slow
std::vector<Case> featureCostCases();
std::vector<Case> bedCostCases();

// Suite "accuracy", "cost", "stability" or "all".
std::vector<Case> casesOf(const std::string& suite);

}  // namespace spherule::measure
