#include "mesh_triangles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>

namespace spherule::support {

using glm::dvec3;

scene::Triangles boxOf(const dvec3& low, const dvec3& high) {
    scene::Triangles box;
    for (unsigned k = 0; k < 8; ++k)
        box.vertices.emplace_back((k & 1U) != 0 ? high.x : low.x, (k & 2U) != 0 ? high.y : low.y,
                                  (k & 4U) != 0 ? high.z : low.z);
    box.corners = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return box;
}

scene::Triangles lathe(const std::vector<glm::dvec2>& line, unsigned sides) {
    scene::Triangles solid;
    std::vector<unsigned> first;  // vertex of each ring
    for (const glm::dvec2& point : line) {
        first.push_back(static_cast<unsigned>(solid.vertices.size()));
        for (unsigned k = 0; k < (point.x > 0 ? sides : 1); ++k) {
            const double angle = 2 * std::numbers::pi * k / sides;
            solid.vertices.emplace_back(point.x * std::cos(angle), point.x * std::sin(angle), point.y);
        }
    }
    for (std::size_t ring = 0; ring + 1 < line.size(); ++ring) {
        const auto at = [&](std::size_t r, unsigned k) { return first[r] + (line[r].x > 0 ? k % sides : 0); };
        for (unsigned k = 0; k < sides; ++k) {
            if (line[ring].x > 0) solid.corners.push_back({at(ring, k), at(ring, k + 1), at(ring + 1, k + 1)});
            if (line[ring + 1].x > 0) solid.corners.push_back({at(ring, k), at(ring + 1, k + 1), at(ring + 1, k)});
        }
    }
    return solid;
}

scene::Triangles randomSheet(const glm::dvec2& low, const glm::dvec2& high, unsigned columns, unsigned rows,
                             unsigned seed, double bump) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> uniform(-0.35, 0.35);
    scene::Triangles sheet;
    const glm::dvec2 cell = (high - low) / glm::dvec2(columns, rows);
    for (unsigned row = 0; row <= rows; ++row)
        for (unsigned column = 0; column <= columns; ++column) {
            glm::dvec2 place(column, row);
            const bool inner = column > 0 && row > 0 && column < columns && row < rows;
            if (inner) place += glm::dvec2(uniform(engine), uniform(engine));
            sheet.vertices.emplace_back(low + place * cell, inner ? bump * (uniform(engine) / 0.7 + 0.5) : 0.0);
        }
    for (unsigned row = 0; row < rows; ++row)
        for (unsigned column = 0; column < columns; ++column) {
            const unsigned a = row * (columns + 1) + column;
            const unsigned b = a + 1;
            const unsigned c = b + columns + 1;
            const unsigned d = a + columns + 1;
            if (uniform(engine) < 0)
                sheet.corners.insert(sheet.corners.end(), {{a, b, c}, {a, c, d}});
            else
                sheet.corners.insert(sheet.corners.end(), {{a, b, d}, {b, c, d}});
        }
    return sheet;
}

scene::Triangles bumpyBall(double radius, double bump, unsigned level) {
    const double t = std::numbers::phi;
    std::vector<dvec3> corners{{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                               {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
    struct Face {
        dvec3 a, b, c;
    };
    std::vector<Face> faces;
    constexpr unsigned first[][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                     {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                     {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                     {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (const auto& f : first) faces.push_back({corners[f[0]], corners[f[1]], corners[f[2]]});
    for (; level > 0; --level) {
        std::vector<Face> finer;
        for (const auto& [a, b, c] : faces) {
            const dvec3 ab = glm::normalize(a) + glm::normalize(b);
            const dvec3 bc = glm::normalize(b) + glm::normalize(c);
            const dvec3 ca = glm::normalize(c) + glm::normalize(a);
            for (const Face& face : {Face{a, ab, ca}, Face{b, bc, ab}, Face{c, ca, bc}, Face{ab, bc, ca}})
                finer.push_back(face);
        }
        faces = std::move(finer);
    }
    scene::Triangles ball;
    const auto add = [&](const dvec3& way) {
        const dvec3 n = glm::normalize(way);
        ball.vertices.push_back(n * (radius + bump * std::sin(7 * n.x + 1) * std::sin(6 * n.y) * std::cos(5 * n.z)));
    };
    for (const auto& [a, b, c] : faces) {
        const auto number = static_cast<unsigned>(ball.vertices.size());
        for (const dvec3& corner : {a, b, c}) add(corner);
        ball.corners.push_back({number, number + 1, number + 2});
    }
    return ball;
}

std::string stlOf(const scene::Triangles& triangles) {
    std::string text(84, ' ');
    const auto put = [&](std::uint32_t word) {
        for (unsigned k = 0; k < 4; ++k) text += static_cast<char>(word >> (8 * k) & 0xffU);
    };
    const auto count = static_cast<std::uint32_t>(triangles.corners.size());
    for (unsigned k = 0; k < 4; ++k) text[80 + k] = static_cast<char>(count >> (8 * k) & 0xffU);
    for (const auto& corners : triangles.corners) {
        for (int k = 0; k < 3; ++k) put(0);
        for (const auto corner : corners)
            for (int axis = 0; axis < 3; ++axis)
                put(std::bit_cast<std::uint32_t>(static_cast<float>(triangles.vertices[corner][axis])));
        text += std::string(2, '\0');
    }
    return text;
}

}  // namespace spherule::support
