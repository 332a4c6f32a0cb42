// Fuzzes the readers of STL and OBJ, and the functions that make a mesh of the triangles. The first byte chooses the
// form.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "scene/mesh/mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace spherule::scene;
    if (size == 0) return 0;
    Check check;
    const MeshBytes from{"mesh", "", std::string_view(reinterpret_cast<const char*>(data) + 1, size - 1)};
    Triangles triangles = readTriangles(check, from);
    if (!check.ok()) return 0;
    const auto form = static_cast<Mesh::Form>(data[0] % 3);
    const auto mesh = Mesh::make(check, from, std::move(triangles), {.form = form});
    if (mesh != nullptr && !std::isfinite(mesh->distance({0.1, 0.2, 0.3}))) std::abort();
    return 0;
}
