#include "host/scene_watch.h"

#include <sys/stat.h>

#include <algorithm>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "scene/load.h"

namespace spherule::host {

SceneWatch::SceneWatch(std::string path, std::chrono::milliseconds period) : path_(std::move(path)) {
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

std::string SceneWatch::name() const {
    return std::filesystem::path(path_).filename().string();
}

// A scene that cannot be read keeps the files that it named before.
void SceneWatch::findFiles() {
    std::vector<std::string> named = scene::filesNamedIn(path_);
    if (named.empty() && !files_.empty() && lookAt(path_).inode != 0) return;
    files_ = {path_};
    files_.insert(files_.end(), named.begin(), named.end());
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

void SceneWatch::watch(const std::stop_token& stop, std::chrono::milliseconds period) {
    std::mutex mutex;
    std::condition_variable_any ended;
    std::unique_lock lock(mutex);
    std::vector<Seen> last = before_;
    while (!ended.wait_for(lock, stop, period, [&stop] { return stop.stop_requested(); })) {
        std::vector<Seen> now = look();
        if (now == std::exchange(last, now) && now != before_) {
            findFiles();
            before_ = last = look();
            changed_ = true;
        }
    }
}

}  // namespace spherule::host
