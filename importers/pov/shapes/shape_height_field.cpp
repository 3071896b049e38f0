// SPDX-License-Identifier: Apache-2.0
// Reads height_field: a grid of heights over the square from 0 to 1 in x and z, from a picture or a
// function. The first row lies at z = 1.
#include "importers/file/text.h"
#include "importers/pov/pictures/image_map.h"
#include "importers/pov/pictures/picture.h"
#include "importers/pov/shapes/shape.h"
#include "importers/pov/values/function.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>

namespace ovc::pov {

namespace {

struct Grid {
    size_t width = 0, height = 0; // points, each at least 2
    std::vector<float> heights;   // in rows from the top down, as in a picture
    bool smooth = false;
    double water_level = 0;

    /// Returns the corner in column i and in row j, which counts from z = 0.
    Corner corner(size_t i, size_t j) const {
        const double x = double(i) / double(width - 1), z = double(j) / double(height - 1);
        return {{x, at(i, j), z}, smooth ? normal(i, j) : dvec3(0)};
    }

private:
    double at(size_t i, size_t j) const { return heights[(height - 1 - j) * width + i]; }

    /// Returns the normal that the heights of the neighbours give. At the rim the point itself
    /// replaces the neighbour that is missing.
    dvec3 normal(size_t i, size_t j) const {
        const size_t i0 = i > 0 ? i - 1 : i, i1 = std::min(i + 1, width - 1);
        const size_t j0 = j > 0 ? j - 1 : j, j1 = std::min(j + 1, height - 1);
        return {(at(i0, j) - at(i1, j)) * double(width - 1) / double(i1 - i0), 1,
                (at(i, j0) - at(i, j1)) * double(height - 1) / double(j1 - j0)};
    }
};

/// Reads WIDTH, HEIGHT { FORMULA }, with x and y from 0 to 1, from behind the word `function`. Of a
/// pigment, the gray of its colors counts.
Grid grid_of_function(Reader& reader, const Token& word) {
    const Function function = parse_function(reader);
    const double width = function.grid.x, height = function.grid.y;
    if (!(width >= 2 && height >= 2 && width * height <= double(kMaxPixels)))
        reader.fail(word.place,
                    fmt::format("found a height_field of {} x {} points, expected 2 x 2 to {}",
                                width, height, kMaxPixels));
    Grid grid;
    grid.width = size_t(width);
    grid.height = size_t(height);
    reader.spend(grid.width * grid.height);
    reader.grow(grid.width * grid.height * sizeof(float));
    grid.heights.reserve(grid.width * grid.height);
    for (size_t row = 0; row < grid.height; ++row)
        for (size_t i = 0; i < grid.width; ++i) {
            const double at[3] = {double(i) / double(grid.width - 1),
                                  double(row) / double(grid.height - 1), 0};
            const Number value = call(reader, word, function, at);
            const double y = function.color ? value.gray() : value.v[0];
            grid.heights.push_back(float(y > 0 ? std::min(y, 1.0) : 0.0)); // NaN counts as 0
        }
    return grid;
}

/// Fractint's pictures of 16 bits have the upper bytes in their left half, the lower in the right.
void add_potential(const Picture& picture, Grid& grid) {
    grid.width = picture.width / 2;
    for (size_t row = 0; row < grid.height; ++row)
        for (size_t i = 0; i < grid.width; ++i) {
            const uint8_t* upper = &picture.indices[row * picture.width + i];
            grid.heights.push_back(float((256 * upper[0] + upper[grid.width]) / 65536.0));
        }
}

/// potential: the picture is one of Fractint's.
Grid grid_of_picture(Reader& reader, bool potential) {
    const Place at = reader.peek().place;
    const std::string name = parse_text(reader);
    const std::filesystem::path path = reader.find_file(name, ".png");
    if (path.empty())
        reader.fail(at, fmt::format("found no file {}, expected a picture", ovc::quoted(name)));
    const Result<Picture> picture = read_picture(path);
    if (!picture)
        reader.fail(at, picture.error().message);
    if (picture->width < 2 || picture->height < 2)
        reader.fail(at, fmt::format("found a height_field of {} x {} points, expected 2 x 2",
                                    picture->width, picture->height));
    Grid grid;
    grid.width = picture->width;
    grid.height = picture->height;
    reader.spend(picture->size() / 16);
    reader.grow(picture->size() * sizeof(float));
    if (potential && !picture->indices.empty() && picture->width >= 4)
        add_potential(*picture, grid);
    else
        for (size_t i = 0; i < picture->size(); ++i)
            grid.heights.push_back(float(height_of(*picture, i)));
    return grid;
}

Grid parse_grid(Reader& reader) {
    static constexpr std::string_view kFormats[] = {"gif", "tga", "pot",  "png", "pgm",
                                                    "ppm", "sys", "jpeg", "iff", "tiff",
                                                    "bmp", "exr", "hdr"};
    const Token token = reader.peek();
    if (reader.take("function"))
        return grid_of_function(reader, token);
    // The name of another format is skipped, because the file itself tells its format.
    const bool potential = token.is("pot");
    if (std::any_of(std::begin(kFormats), std::end(kFormats),
                    [&](std::string_view word) { return token.is(word); }))
        reader.next();
    return grid_of_picture(reader, potential);
}

enum class Side { Above, Below };

/// Returns the place on the way from a to b at the level that lies between them. It is the same,
/// bit for bit, on the way from b to a.
Corner at_level(const Corner& a, const Corner& b, double level) {
    if (a.position.y > b.position.y)
        return at_level(b, a, level);
    const double t = (level - a.position.y) / (b.position.y - a.position.y);
    return {glm::mix(a.position, b.position, t), glm::mix(a.normal, b.normal, t)};
}

/// Adds the part of the triangle on this side of the level. What lies on it is above.
void add_part(const std::array<Corner, 3>& triangle, double level, Side side, Facets& out) {
    std::vector<Corner> kept;
    for (size_t i = 0; i < 3; ++i) {
        const Corner &a = triangle[i], &b = triangle[(i + 1) % 3];
        const bool is_above = a.position.y >= level;
        if (is_above == (side == Side::Above))
            kept.push_back(a);
        if (is_above != (b.position.y >= level))
            kept.push_back(at_level(a, b, level));
    }
    for (size_t i = 1; i + 1 < kept.size(); ++i)
        out.add(kept[0], kept[i], kept[i + 1]);
}

/// Adds two triangles for each cell, which is cut from (x + 1, z) to (x, z + 1) as in POV-Ray.
void cut_grid(const Grid& grid, Side side, Facets& out) {
    assert(grid.width >= 2 && grid.height >= 2);
    assert(grid.heights.size() == grid.width * grid.height);
    const bool is_smooth = out.smooth || grid.smooth; // add() of corners sets out.smooth
    for (size_t j = 0; j + 1 < grid.height; ++j)
        for (size_t i = 0; i + 1 < grid.width; ++i) {
            const Corner right = grid.corner(i + 1, j), back = grid.corner(i, j + 1);
            add_part({grid.corner(i, j), back, right}, grid.water_level, side, out);
            add_part({grid.corner(i + 1, j + 1), right, back}, grid.water_level, side, out);
        }
    out.smooth = is_smooth;
}

/// Returns the corners along the rim, counterclockwise seen from above, with those where it crosses
/// the water.
std::vector<dvec3> rim_of(const Grid& grid) {
    const size_t x = grid.width - 1, z = grid.height - 1;
    std::vector<Corner> corners;
    for (size_t j = 0; j < z; ++j)
        corners.push_back(grid.corner(0, j));
    for (size_t i = 0; i < x; ++i)
        corners.push_back(grid.corner(i, z));
    for (size_t j = z; j > 0; --j)
        corners.push_back(grid.corner(x, j));
    for (size_t i = x; i > 0; --i)
        corners.push_back(grid.corner(i, 0));
    std::vector<dvec3> rim;
    for (size_t i = 0; i < corners.size(); ++i) {
        const Corner &a = corners[i], &b = corners[(i + 1) % corners.size()];
        rim.push_back(a.position);
        if ((a.position.y >= grid.water_level) != (b.position.y >= grid.water_level))
            rim.push_back(at_level(a, b, grid.water_level).position);
    }
    return rim;
}

/// Adds what bounds the inside: the surface under the water, walls and a floor. povray's inside is
/// all that lies below the surface, however far.
void close_grid(const Grid& grid, Facets& out) {
    constexpr double kFloor = -1000; // as deep as nobody cuts
    cut_grid(grid, Side::Below, out);
    const std::vector<dvec3> rim = rim_of(grid);
    const dvec3 middle(0.5, kFloor, 0.5);
    for (size_t i = 0; i < rim.size(); ++i) {
        const dvec3 &a = rim[i], &b = rim[(i + 1) % rim.size()];
        const dvec3 under_a(a.x, kFloor, a.z), under_b(b.x, kFloor, b.z);
        out.add_quad(b, a, under_a, under_b);
        out.add(under_b, under_a, middle);
    }
}

} // namespace

Shape parse_height_field(Reader& reader) {
    Grid grid = parse_grid(reader);
    for (bool more = true; more;) {
        if (reader.take("smooth"))
            grid.smooth = parse_flag(reader);
        else if (reader.take("water_level"))
            grid.water_level = parse_float(reader);
        else if (reader.take("gamma")) {
            const double gamma = parse_gamma(reader);
            for (float& height : grid.heights)
                height = float(gamma == kSrgbGamma ? from_srgb(double(height), 1)
                                                   : std::pow(double(height), gamma));
        } else
            more = reader.take(',');
    }
    Shape shape;
    shape.fixed = 2 * double(grid.width - 1) * double(grid.height - 1);
    const auto shared = std::make_shared<const Grid>(std::move(grid));
    shape.cut = [shared](int, bool, Facets& out) { cut_grid(*shared, Side::Above, out); };
    shape.close = [shared](int, Facets& out) { close_grid(*shared, out); };
    return shape;
}

} // namespace ovc::pov
