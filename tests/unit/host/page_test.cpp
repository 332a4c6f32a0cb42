#include "host/page.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace spherule::host {
namespace {

TEST(Page, FilesHaveTypesAndTwoFormsWithTagsOfTheirOwn) {
    const Page page;
    std::set<std::string> tags;
    for (const auto& [path, type] : {std::pair{"/", "text/html; charset=utf-8"},
                                     {"/viewer.js", "text/javascript; charset=utf-8"},
                                     {"/worker.js", "text/javascript; charset=utf-8"},
                                     {"/style.css", "text/css; charset=utf-8"},
                                     {"/favicon.svg", "image/svg+xml"}}) {
        const net::StaticFile* const file = page.find(path);
        ASSERT_NE(file, nullptr) << path;
        EXPECT_EQ(file->contentType, type);
        EXPECT_LT(file->gzip.bytes.size(), file->plain.bytes.size()) << path;
        EXPECT_EQ(file->gzip.bytes.substr(0, 2), "\x1f\x8b") << path;
        for (const auto* const form : {&file->plain, &file->gzip})
            EXPECT_TRUE(tags.insert(form->tag).second) << path << " " << form->tag;
    }
}

TEST(Page, TagDependsOnTheBytesAlone) {
    const std::string tag = Page().find("/")->plain.tag;
    EXPECT_EQ(tag, Page().find("/index.html")->plain.tag);
    EXPECT_EQ(tag.size(), 34U) << tag;
    EXPECT_EQ(tag.front(), '"') << tag;
    EXPECT_EQ(tag.back(), '"') << tag;
}

TEST(Page, OtherPathsHaveNoFile) {
    const Page page;
    for (const char* const path : {"", "//", "/viewer.js.gz", "/viewer", "viewer.js", "/nothing"})
        EXPECT_EQ(page.find(path), nullptr) << path;
}

}  // namespace
}  // namespace spherule::host
