#include "host/scene_watch.h"

#include <sys/stat.h>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "core/heartbeat.h"
#include "core/log.h"

namespace spherule::host {

namespace {

std::string nameOf(const std::string& path) {
    return std::filesystem::path(path).filename().string();
}

bool contains(const std::vector<std::string>& files, const std::string& file) {
    return std::ranges::find(files, file) != files.end();
}

}  // namespace

SceneWatch::SceneWatch(std::string path, std::chrono::milliseconds period, FilesNamed named)
    : path_(std::move(path)), named_(std::move(named)), files_{path_} {
    const heartbeat::Pause reading;
    findFiles();
    before_ = look();
    thread_ = std::jthread([this, period](const std::stop_token& stop) { watch(stop, period); });
}

MakeScene SceneWatch::load(const std::string& deviceKind, const scene::Overrides& overrides) const {
    return [path = path_, deviceKind, overrides](Progress& progress) -> Result<scene::Scene> {
        constexpr std::size_t mostShown = 10;
        auto scene = scene::load(path, deviceKind, overrides, &progress);
        if (scene || scene.error().kind == ErrorKind::Cancelled) return scene;
        const std::vector<Error> mistakes = scene::structuralMistakesOf(path);
        if (mistakes.size() < 2) return scene;
        std::string text = fmt::format("It has {} mistakes:", mistakes.size());
        for (std::size_t k = 0; k < std::min(mostShown, mistakes.size()); ++k)
            text.append("\n").append(mistakes[k].text());
        if (mistakes.size() > mostShown) text += "\n...";
        return fail(ErrorKind::Input, "", text);
    };
}

std::optional<std::string> SceneWatch::savedToLoad(const Change& change) const {
    if (change.saved.empty() || contains(change.gone, path_)) return std::nullopt;
    return contains(change.saved, path_) ? path_ : change.saved.front();
}

std::string SceneWatch::goneText(const std::string& file) const {
    const std::string which = file == path_ ? "" : fmt::format(", which {} names,", name());
    return fmt::format("{}{} is gone. The world goes on as it is. Save the file again to load it.", nameOf(file),
                       which);
}

std::string SceneWatch::failureText(const std::string& saved, const Error& error) const {
    const std::string subject = saved == path_ ? "" : fmt::format(" {}", name());
    const bool ended = error.cause == Cause::Ended || error.cause == Cause::Cancelled || error.cause == Cause::Stopping;
    return fmt::format("{} was saved but{} is not loaded{} {}{}", nameOf(saved), subject,
                       ended ? ":" : ", the world stays as it is.", error.text(),
                       ended ? ". Save it again to load it." : "");
}

std::string SceneWatch::name() const {
    return nameOf(path_);
}

std::optional<SceneWatch::Change> SceneWatch::takeChange() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(change_, std::nullopt);
}

// A scene that cannot be read keeps the files that it named before.
void SceneWatch::findFiles() {
    const auto named = named_(path_);
    if (!named && lookAt(path_).inode != 0) return;
    files_ = {path_};
    if (named) files_.insert(files_.end(), named->begin(), named->end());
}

SceneWatch::Seen SceneWatch::lookAt(const std::string& file) {
    struct stat status {};
    if (stat(file.c_str(), &status) != 0) return {};
    return {.inode = status.st_ino,
            .size = status.st_size,
            .seconds = status.st_mtim.tv_sec,
            .nanoseconds = status.st_mtim.tv_nsec};
}

std::vector<SceneWatch::Seen> SceneWatch::look() const {
    std::vector<Seen> seen;
    for (const std::string& file : files_) seen.push_back(lookAt(file));
    return seen;
}

// Adds to the changes that are not taken yet.
void SceneWatch::report(const Change& change) {
    const std::scoped_lock lock(mutex_);
    if (!change_) change_.emplace();
    const auto move = [](const std::string& file, std::vector<std::string>& from, std::vector<std::string>& to) {
        std::erase(from, file);
        if (!contains(to, file)) to.push_back(file);
    };
    for (const std::string& file : change.saved) move(file, change_->gone, change_->saved);
    for (const std::string& file : change.gone) move(file, change_->saved, change_->gone);
}

// `last`: the states of the files in the look before.
void SceneWatch::lookForChanges(std::vector<Seen>& last) {
    std::vector<Seen> now = look();
    if (now != std::exchange(last, now) || now == before_) return;
    Change change;
    for (std::size_t k = 0; k < now.size(); ++k)
        if (now[k] != before_[k]) (now[k].inode != 0 ? change.saved : change.gone).push_back(files_[k]);
    findFiles();
    before_ = last = look();
    std::erase_if(change.gone, [this](const std::string& file) { return !contains(files_, file); });
    report(change);
}

void SceneWatch::watch(const std::stop_token& stop, std::chrono::milliseconds period) {
    std::mutex mutex;
    std::condition_variable_any ended;
    std::unique_lock lock(mutex);
    std::vector<Seen> last = before_;
    bool failed = false;
    while (!ended.wait_for(lock, stop, period, [&stop] { return stop.stop_requested(); })) {
        try {
            lookForChanges(last);
            failed = false;
        } catch (const std::exception& error) {
            if (!std::exchange(failed, true))
                spdlog::warn("cannot look whether {} was saved, and looks again: {}", path_, error.what());
        }
    }
}

}  // namespace spherule::host
