#include "net/command_rules.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "client/command_parser.h"

namespace spherule::net {
namespace {

// The names of the commands for which the rule holds.
template <class Rule>
std::set<std::string> commandsWith(Rule rule) {
    std::set<std::string> names;
    for (const auto* const kind : commandFields()) {
        v1::Command command;
        command.GetReflection()->MutableMessage(&command, kind);
        if (rule(rulesOf(command))) names.insert(kind->name());
    }
    return names;
}

using Names = std::set<std::string>;

TEST(CommandRules, ExistForEveryCommand) {
    ASSERT_GE(commandFields().size(), 13U);
    for (const auto* const kind : commandFields()) {
        EXPECT_TRUE(kind->options().HasExtension(v1::command_rules))
            << kind->name() << ": give it the option command_rules in control.proto";
        ASSERT_NE(kind->message_type(), nullptr) << kind->name() << ": a command is a message";
    }
}

struct Row {
    const char* command;
    bool viewerMay, changesWorld, waitsForChange, endsSteps, whilePlaying;
};

class RulesOf : public testing::TestWithParam<Row> {};

TEST_P(RulesOf, MatchControlProto) {
    const Row& row = GetParam();
    const auto* const kind = v1::Command::descriptor()->FindFieldByName(row.command);
    ASSERT_NE(kind, nullptr);
    v1::Command command;
    command.GetReflection()->MutableMessage(&command, kind);
    const v1::CommandRules& rules = rulesOf(command);
    EXPECT_EQ(rules.viewer_may(), row.viewerMay);
    EXPECT_EQ(rules.changes_world(), row.changesWorld);
    EXPECT_EQ(rules.waits_for_change(), row.waitsForChange);
    EXPECT_EQ(rules.ends_steps(), row.endsSteps);
    EXPECT_EQ(rules.while_playing(), row.whilePlaying);
}

constexpr bool yes = true;
constexpr bool no = false;

INSTANTIATE_TEST_SUITE_P(CommandRules, RulesOf,
                         testing::Values(Row{"pause", no, no, no, yes, yes}, Row{"resume", no, no, no, yes, yes},
                                         Row{"step", no, no, yes, no, yes}, Row{"reset", no, yes, no, yes, yes},
                                         Row{"load", no, yes, no, yes, no}, Row{"set", no, yes, yes, no, yes},
                                         Row{"spawn", no, yes, yes, no, no}, Row{"push", no, yes, yes, no, no},
                                         Row{"pull", no, no, yes, no, no}, Row{"release", no, no, yes, no, no},
                                         Row{"query", yes, no, no, no, no}, Row{"seek", no, no, no, no, yes},
                                         Row{"start_recording", no, no, no, no, no},
                                         Row{"stop_recording", no, no, no, no, no}, Row{"cancel", no, no, no, no, no}),
                         [](const auto& row) { return std::string(row.param.command); });

TEST(CommandRules, CommandsOfViewersChangeNothing) {
    const auto wrong = [](const v1::CommandRules& rules) {
        return rules.viewer_may() && (rules.changes_world() || rules.ends_steps() || rules.while_playing());
    };
    EXPECT_EQ(commandsWith(wrong), Names());
}

TEST(CommandRules, NameOfACommandIsItsField) {
    v1::Command command;
    EXPECT_EQ(nameOf(command), "");
    EXPECT_FALSE(rulesOf(command).viewer_may());
    command.mutable_pause();
    EXPECT_EQ(nameOf(command), "pause");
    command.mutable_start_recording();
    EXPECT_EQ(nameOf(command), "start_recording");
}

// A command with help takes its fields as words, so each field has a type that can be read from one.
TEST(CommandRules, CommandsWithHelpAreParsedFromWords) {
    for (const std::string& name : commandsWith([](const auto& rules) { return !rules.help().empty(); })) {
        const auto& type = *v1::Command::descriptor()->FindFieldByName(name)->message_type();
        std::vector<std::string> words{name};
        for (int k = 0; k < type.field_count(); ++k) words.emplace_back("1");
        const auto command = client::commandFrom(words);
        ASSERT_TRUE(command) << command.error().text();
        EXPECT_EQ(nameOf(*command), name);
        const std::string forms = client::commandForms();
        EXPECT_TRUE(forms.starts_with("  " + name) || forms.find("\n  " + name) != std::string::npos) << forms;
    }
}

}  // namespace
}  // namespace spherule::net
