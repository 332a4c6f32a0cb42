#include "host/scene_saver.h"

#include <exception>
#include <new>
#include <utility>

#include "core/memory.h"
#include "host/saved_scene.h"
#include "scene/describe.h"
#include "sim/memory_needs.h"
#include "sim/simulation.h"

namespace spherule::host {

namespace {

constexpr std::chrono::seconds period{1};

std::vector<std::vector<std::uint32_t>> ranksByGroup(const scene::Scene& scene) {
    std::vector<std::vector<std::uint32_t>> ranks(scene.groups.size());
    for (std::size_t group = 0; group < ranks.size(); ++group) ranks[group].reserve(scene.groups[group].count);
    for (std::uint32_t rank = 0; rank < scene.spheres.size(); ++rank)
        ranks.at(scene.spheres[rank].group).push_back(rank);
    return ranks;
}

}  // namespace

void SceneSaver::refuse(const Made& made, int status, const std::string& text) {
    made(nullptr, {status, "text/plain; charset=utf-8", text + "\n"});
}

void SceneSaver::fail(const Made& made, const std::string& text) {
    {
        const std::lock_guard lock(mutex_);
        busy_ = false;
    }
    refuse(made, 503, text);
}

void SceneSaver::open() {
    const std::lock_guard lock(mutex_);
    open_ = true;
}

void SceneSaver::close() {
    std::unique_lock lock(mutex_);
    open_ = false;
    const Made made = std::exchange(asked_, {});
    lock.unlock();
    if (made) fail(made, "the server is stopping");
}

void SceneSaver::ask(Made made) {
    std::unique_lock lock(mutex_);
    const bool open = open_;
    const bool free = open && !busy_ && document_.expired() && Clock::now() >= next_;
    if (free) {
        busy_ = true;
        next_ = Clock::now() + period;
        asked_ = std::move(made);
        return;
    }
    lock.unlock();
    if (open)
        refuse(made, 503, "another scene is being saved: try again soon");
    else
        refuse(made, 404, "this server simulates no scene");
}

void SceneSaver::serve(sim::Simulation& simulation) {
    std::unique_lock lock(mutex_);
    const Made made = std::exchange(asked_, {});
    lock.unlock();
    if (!made) return;
    auto claim = memory::Claim::make("", "a copy of the state", 2 * sim::copiesToHash(simulation.plan()));
    if (!claim) return fail(made, claim.error().text());
    const scene::Scene& scene = simulation.scene();
    making_ = std::async(
        std::launch::async,
        [this, made, claim = std::move(*claim),
         message = scene::describe(scene, simulation.time(), simulation.flows().emission.progress(scene)),
         ranks = ranksByGroup(scene), slots = simulation.pipeline().download(), population = simulation.population(),
         centre = scene.bounds.centre()]() mutable {
            std::shared_ptr<SavedScene> document;
            try {
                document = std::make_shared<SavedScene>(std::move(message), std::move(ranks),
                                                        sim::inIdOrder(slots, population), centre, std::move(claim));
            } catch (const std::bad_alloc&) {
                return fail(made, "there is no memory for a copy of the state: save the scene again when there is");
            } catch (const std::exception& error) {
                return fail(made, std::string("the scene cannot be saved: ") + error.what());
            }
            {
                const std::lock_guard guard(mutex_);
                busy_ = false;
                document_ = document;
            }
            made(document, {});
        });
}

}  // namespace spherule::host
