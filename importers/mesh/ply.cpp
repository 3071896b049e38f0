// SPDX-License-Identifier: Apache-2.0
// The PLY reader streams polygons and triangle strips, in ASCII and in binary of either byte order.
#include "core/file/triangle_sink.h"
#include "importers/file/text.h"
#include "importers/mesh/blocks.h"
#include "importers/mesh/ply_rows.h"
#include "importers/mesh/polygon.h"
#include "importers/origin.h"
#include "importers/readers.h"
#include "importers/scratch/spilling_array.h"

#include <cassert>

namespace ovc {

namespace {

/// The use that the reader has for a row's property.
enum class Role : uint8_t { Skipped, Position, Normal, Texture, Indices };

struct Column {
    PlyProperty property;
    Role role = Role::Skipped;
    int axis = 0;
};

struct Layout {
    std::vector<Column> columns;
    bool has_normals = false;
    bool has_uv = false;
};

/// Returns the numbers of the properties of a vertex that are its texture coordinates, whose names
/// differ between programs.
std::optional<std::array<int, 2>> uv_columns(const PlyElement& vertices) {
    constexpr std::array<std::string_view, 2> kNames[] = {
        {"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}};
    for (const auto& [u, v] : kNames)
        if (const std::array at{vertices.find(u), vertices.find(v)}; at[0] >= 0 && at[1] >= 0)
            return at;
    return std::nullopt;
}

Layout vertex_layout(const PlyElement& element, bool with_uv) {
    constexpr std::string_view kPosition[] = {"x", "y", "z"};
    constexpr std::string_view kNormal[] = {"nx", "ny", "nz"};
    Layout layout;
    for (const PlyProperty& property : element.properties)
        layout.columns.push_back({property});
    int normals = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const int p = element.find(kPosition[axis]);
        const int n = element.find(kNormal[axis]);
        if (p >= 0)
            layout.columns[size_t(p)] = {element.properties[size_t(p)], Role::Position, axis};
        if (n < 0 || element.properties[size_t(n)].is_list)
            continue;
        layout.columns[size_t(n)] = {element.properties[size_t(n)], Role::Normal, axis};
        ++normals;
    }
    layout.has_normals = normals == 3;
    const auto uv = with_uv ? uv_columns(element) : std::nullopt;
    layout.has_uv = uv && !element.properties[size_t((*uv)[0])].is_list &&
                    !element.properties[size_t((*uv)[1])].is_list;
    for (int i = 0; i < 2 && layout.has_uv; ++i)
        layout.columns[size_t((*uv)[size_t(i)])] = {element.properties[size_t((*uv)[size_t(i)])],
                                                    Role::Texture, i};
    return layout;
}

/// Texture coordinates stand at vertices, or at the corners of faces, as VCGLIB writes them.
bool has_texture_coordinates(const PlyHeader& header) {
    const PlyElement* vertices = header.find("vertex");
    if (vertices && uv_columns(*vertices))
        return true;
    const PlyElement* faces = header.find("face");
    return faces && faces->find("texcoord") >= 0;
}

/// Returns the property that holds a polygon's vertices; -1 if there is none.
int index_list(const PlyElement& element) {
    const int list = element.find("vertex_indices");
    return list >= 0 ? list : element.find("vertex_index");
}

/// The corners of polygons whose vertices come later in the file.
struct Pending {
    std::vector<uint32_t> indices;
    std::vector<uint32_t> lengths;
};

/// V is vec3 if the types in the header hold floats only, else dvec3.
template <class Rows, class V>
class PlyReader {
public:
    PlyReader(Source& source, const PlyHeader& header, const ImportOptions& options)
        : source_(source),
          header_(header),
          rows_(source),
          with_uv_(options.texture_coordinates),
          streaming_(options.streaming),
          vertices_(stored<V>(options.streaming, 2)),
          normals_(stored<vec3>(options.streaming, 4)),
          vertex_element_(header.find("vertex")),
          vertex_count_(vertex_element_ ? vertex_element_->count : 0) {}

    bool read() {
        if (streaming_)
            streaming_->sink.begin_mesh();
        for (const PlyElement& element : header_.elements)
            if (!read_element(element))
                return false;
        for (size_t i = 0, first = 0; i < pending_.lengths.size(); first += pending_.lengths[i++])
            if (!add_triangles({pending_.indices.data() + first, pending_.lengths[i]}))
                return false;
        return !streaming_ || pass_on();
    }

    Error error() const {
        if (const Error* failed = disk_error())
            return *failed;
        return is_wanted_ ? rows_.error() : Error{"cancelled", ErrorKind::Cancelled};
    }
    /// Return warnings after read(); left_over() does so once only.
    std::optional<Error> surplus() const { return rows_.surplus(); }
    std::optional<Error> left_over() { return rows_.left_over(); }
    uint64_t triangle_count() const { return (passed_on_ + corners_.size()) / 3; }
    uint64_t too_short() const { return too_short_; }
    bool lost_normals() const { return lost_normals_; }

    Scene take(std::string name) {
        Scene scene;
        scene.name = name;
        scene.materials.emplace_back();
        vertices_.clear();
        const uint64_t corners = 3 * triangle_count();
        scene.add_mesh(std::move(name), 0, Chunk::owning(origin_, corners_.take()),
                       normals_.empty() ? std::vector<vec3>() : corner_normals_.take());
        scene.meshes[0].normals_left_out = lost_normals_ ? corners : 0;
        if (!uv_.empty())
            scene.meshes[0].uv = corner_uv_.take();
        else if (has_texture_coordinates(header_))
            scene.meshes[0].texture_coordinates_left_out = corners;
        return scene;
    }

private:
    /// Returns an array that takes a part of the memory where the file streams.
    template <class T>
    static SpillingArray<T> stored(const Streaming* streaming, uint64_t part) {
        return streaming ? SpillingArray<T>(streaming->folder, streaming->host_bytes / part)
                         : SpillingArray<T>();
    }
    const Error* disk_error() const {
        return vertices_.error() ? vertices_.error() : normals_.error();
    }

    bool read_element(const PlyElement& element) {
        if (&element == vertex_element_)
            return read_vertices(element);
        if (element.name == "face")
            return read_polygons(element, /* strips= */ false);
        if (element.name == "tristrips")
            return read_polygons(element, /* strips= */ true);
        // Rows without properties take no bytes, so a file may claim any number of them.
        for (uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
            if (!skip_row(element))
                return false;
        return true;
    }

    bool skip_row(const PlyElement& element) {
        if (!rows_.begin_row(element))
            return false;
        for (const PlyProperty& property : element.properties)
            if (!skip(property))
                return false;
        return rows_.end_row();
    }

    bool skip(const PlyProperty& property) {
        return property.is_list ? rows_.skip_list(property) : rows_.skip_scalar(property);
    }

    /// Returns how many rows the rest of the file can hold, whatever the file claims.
    size_t plausible_rows(const PlyElement& element, uint64_t row_bytes) const {
        const uint64_t left =
            source_.likely_bytes() - std::min(source_.likely_bytes(), source_.offset());
        return size_t(std::min(element.count, left / std::max<uint64_t>(row_bytes, 1)));
    }

    bool read_vertices(const PlyElement& element) {
        const Layout layout = vertex_layout(element, with_uv_);
        const size_t rows = plausible_rows(element, element.shortest_row(header_.format));
        vertices_.reserve(rows);
        if (layout.has_normals)
            normals_.reserve(rows);
        for (uint64_t i = 0; i < element.count; ++i) {
            V position(0);
            vec3 normal(0);
            vec2 uv(0);
            if (!rows_.begin_row(element))
                return false;
            for (const Column& column : layout.columns)
                if (!read_column(column, position, normal, uv))
                    return false;
            if (!rows_.end_row())
                return false;
            vertices_.push_back(position);
            if (layout.has_normals)
                add_normal(normal);
            if (layout.has_uv)
                uv_.push_back(uv);
        }
        place_origin();
        return !disk_error();
    }

    bool read_column(const Column& column, V& position, vec3& normal, vec2& uv) {
        switch (column.role) {
        case Role::Position:
            return rows_.scalar(column.property, position[column.axis]);
        case Role::Normal:
            return rows_.scalar(column.property, normal[column.axis]);
        case Role::Texture:
            return rows_.scalar(column.property, uv[column.axis]);
        default:
            return skip(column.property);
        }
    }

    void add_normal(vec3 normal) {
        if (lost_normals_)
            return;
        const float length = glm::length(normal);
        if (is_finite(normal) && std::isfinite(length) && length > 0) {
            normals_.push_back(std::abs(length - 1) > 1e-6f ? normal / length : normal);
            return;
        }
        lost_normals_ = true;
        normals_.clear();
    }

    void place_origin() {
        if constexpr (std::same_as<V, dvec3>) {
            Box bounds;
            bool are_floats = true;
            for (size_t i = 0; i < vertices_.size(); ++i) {
                const dvec3 v = vertices_[i];
                if (!is_finite(v))
                    continue;
                bounds.add(v);
                are_floats = are_floats && dvec3(vec3(v)) == v;
            }
            if (!are_floats)
                origin_ = chunk_origin(bounds, /* far= */ 1);
        }
        vertices_ready_ = true;
    }

    bool read_polygons(const PlyElement& element, bool strips) {
        const int list = index_list(element);
        const uint64_t triangle_bytes = header_.format == PlyFormat::Ascii ? 8 : 4;
        if (!strips)
            corners_.reserve(
                std::min(streaming_ ? kPart : ~size_t(0),
                         3 * plausible_rows(element, element.shortest_row(header_.format) +
                                                         triangle_bytes)));
        for (uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
            if (!rows_.begin_row(element))
                return false;
            for (size_t p = 0; p < element.properties.size(); ++p) {
                const PlyProperty& property = element.properties[p];
                if (int(p) != list ? !skip(property) : !read_indices(property, strips))
                    return false;
            }
            if (!rows_.end_row())
                return false;
            if (!(strips ? add_strip() : add_polygon(polygon_)))
                return false;
        }
        return true;
    }

    bool read_indices(const PlyProperty& property, bool strips) {
        if (!rows_.list(property, row_))
            return false;
        polygon_.clear();
        for (const int64_t index : row_) {
            const bool restarts = strips && index == -1;
            if (!restarts && (index < 0 || uint64_t(index) >= vertex_count_))
                return fail_index(index);
            polygon_.push_back(restarts ? kRestart : uint32_t(index));
        }
        return true;
    }

    bool fail_index(int64_t index) {
        return rows_.fail(fmt::format("vertex index {}", index),
                          vertex_count_ == 0   ? "none, for there are no vertices"
                          : vertex_count_ == 1 ? "0, the only one"
                                               : fmt::format("0 to {}", vertex_count_ - 1));
    }

    /// Every other triangle of a strip is wound the other way; kRestart begins a new strip.
    bool add_strip() {
        uint32_t a = 0, b = 0, length = 0;
        for (const uint32_t c : polygon_) {
            if (c == kRestart) {
                length = 0;
                continue;
            }
            if (length >= 2 &&
                !add_polygon(length % 2 == 0 ? std::array{a, b, c} : std::array{b, a, c}))
                return false;
            a = b;
            b = c;
            ++length;
        }
        return true;
    }

    bool add_polygon(std::span<const uint32_t> indices) {
        if (indices.size() < 3) {
            ++too_short_;
        } else if (vertices_ready_) {
            return add_triangles(indices);
        } else {
            pending_.indices.insert(pending_.indices.end(), indices.begin(), indices.end());
            pending_.lengths.push_back(uint32_t(indices.size()));
        }
        return true;
    }

    bool add_triangles(std::span<const uint32_t> indices) {
        assert(indices.size() >= 3);
        if (indices.size() == 3)
            for (const uint32_t index : indices)
                add_corner(index);
        else
            add_cut(indices);
        return !streaming_ || (!disk_error() && (corners_.size() < kPart || pass_on()));
    }

    void add_cut(std::span<const uint32_t> indices) {
        outline_.clear();
        for (const uint32_t index : indices)
            outline_.emplace_back(vertices_[index]);
        cut_.clear();
        triangulate(outline_, cut_);
        for (const auto& triangle : cut_)
            for (const uint32_t corner : triangle)
                add_corner(indices[corner]);
    }

    void add_corner(uint32_t index) {
        assert(vertices_ready_ && index < vertices_.size());
        assert(normals_.empty() || normals_.size() == vertices_.size());
        if constexpr (std::same_as<V, dvec3>)
            corners_.push_back(vec3(vertices_[index] - origin_));
        else
            corners_.push_back(vertices_[index]);
        if (!normals_.empty())
            corner_normals_.push_back(normals_[index]);
        if (!uv_.empty())
            corner_uv_.push_back(uv_[index]);
    }

    /// Hands what was read to the sink of a scene that streams.
    bool pass_on() {
        const std::vector<vec3> corners = corners_.take(), normals = corner_normals_.take();
        passed_on_ += corners.size();
        is_wanted_ = streaming_->sink.add_corners(corners) &&
                     (normals.empty() || streaming_->sink.add_normals(normals));
        return is_wanted_;
    }

    static constexpr uint32_t kRestart = 0xffffffffu;
    static constexpr size_t kPart = 1 << 16; // corners that are handed on at once, or more

    Source& source_;
    const PlyHeader& header_;
    Rows rows_;
    std::vector<vec2> uv_; // one per vertex, or empty
    const bool with_uv_;   // they are wanted
    const Streaming* const streaming_;
    SpillingArray<V> vertices_;
    SpillingArray<vec3> normals_;            // one per vertex, or empty
    const PlyElement* const vertex_element_; // null: none
    const uint64_t vertex_count_;
    bool is_wanted_ = true;  // by its sink
    uint64_t passed_on_ = 0; // corners that it has got
    bool vertices_ready_ = false;
    bool lost_normals_ = false;
    uint64_t too_short_ = 0; // polygons with fewer than three corners
    dvec3 origin_{0};
    Blocks<vec3> corners_;
    Blocks<vec3> corner_normals_;
    Blocks<vec2> corner_uv_;
    Pending pending_;
    std::vector<int64_t> row_;      // the row's indices as stored
    std::vector<uint32_t> polygon_; // the same, checked
    std::vector<dvec3> outline_;
    std::vector<std::array<uint32_t, 3>> cut_;
};

bool has_colors(const PlyElement* element) {
    for (const char* red : {"red", "diffuse_red", "r"})
        if (element && element->find(red) >= 0)
            return true;
    return false;
}

/// Returns a sentence on each kind of thing that the header tells of and the reader passes over.
std::vector<std::string> left_out_of(const PlyHeader& header) {
    std::vector<std::string> sentences, others, textures;
    for (const char* element : {"vertex", "face"})
        if (has_colors(header.find(element)))
            sentences.push_back(fmt::format("{} colors left out", element));
    for (const PlyElement& element : header.elements)
        if (element.count > 0 && !element.properties.empty() && &element != header.find("vertex") &&
            element.name != "face" && element.name != "tristrips")
            others.push_back(ovc::quoted(element.name));
    for (const std::string& texture : header.textures)
        textures.push_back(ovc::quoted(texture));
    if (!others.empty())
        sentences.push_back(
            fmt::format("{} left out: {}", counted(others.size(), "element"), listed(others)));
    if (!textures.empty())
        sentences.push_back(
            fmt::format("{} left out: {}", counted(textures.size(), "texture"), listed(textures)));
    return sentences;
}

template <class Rows, class V>
Result<Scene> read_body(Source& source, const PlyHeader& header, const std::filesystem::path& path,
                        const ImportOptions& options) {
    PlyReader<Rows, V> reader(source, header, options);
    if (!reader.read())
        return reader.error();
    const std::optional<Error> left_over = reader.left_over();
    if (source.is_damaged())
        return source.error_at_byte(source.offset(), "");
    if (reader.triangle_count() > kMaxTriangles)
        return source.error(fmt::format("found {} triangles, expected at most {}",
                                        reader.triangle_count(), kMaxTriangles));
    const auto warn = [&](const std::string& sentence) {
        say(options.log, LogLevel::Warning, source.error(sentence).message);
    };
    for (const auto& warning : {reader.surplus(), left_over})
        if (warning)
            say(options.log, LogLevel::Warning, warning->message);
    if (reader.too_short() > 0)
        warn(fmt::format("{} with fewer than three corners left out",
                         counted(reader.too_short(), "polygon")));
    if (reader.lost_normals())
        warn("normals left out: some are zero or not finite");
    for (const std::string& sentence : left_out_of(header))
        warn(sentence);
    if (reader.triangle_count() == 0)
        warn("it has no triangles");
    return reader.take(path.stem().string());
}

template <class Rows>
Result<Scene> read_body(Source& source, const PlyHeader& header, const std::filesystem::path& path,
                        const ImportOptions& options) {
    const PlyElement* vertices = header.find("vertex");
    for (const char* axis : {"x", "y", "z"})
        if (const int at = vertices ? vertices->find(axis) : -1; at >= 0)
            if (exceeds_float(vertices->properties[size_t(at)].type))
                return read_body<Rows, dvec3>(source, header, path, options);
    return read_body<Rows, vec3>(source, header, path, options);
}

/// Checks that the header describes a model.
std::optional<Error> check(const PlyHeader& header, const Source& source) {
    if (const PlyElement* vertices = header.find("vertex"))
        for (const char* axis : {"x", "y", "z"})
            if (const int at = vertices->find(axis);
                at < 0 || vertices->properties[size_t(at)].is_list)
                return source.error_at_line(fmt::format(
                    "found an element vertex without a property {}, expected x, y and z", axis));
    for (const PlyElement& element : header.elements) {
        if ((element.name != "face" && element.name != "tristrips") || element.count == 0)
            continue;
        const int list = index_list(element);
        if (list < 0 || !element.properties[size_t(list)].is_list ||
            !is_integer(element.properties[size_t(list)].type))
            return source.error_at_line(fmt::format("found an element {} without vertex_indices, "
                                                    "expected a list of integers of that name",
                                                    element.name));
    }
    return std::nullopt;
}

} // namespace

Result<Scene> read_ply(const std::filesystem::path& path, const ImportOptions& options) {
    Result<Source> source = Source::open(path, options.files);
    if (!source)
        return source.error();
    const Result<PlyHeader> header = read_ply_header(*source);
    if (!header)
        return header.error();
    if (const auto error = check(*header, *source))
        return *error;
    switch (header->format) {
    case PlyFormat::Ascii:
        return read_body<AsciiRows>(*source, *header, path, options);
    case PlyFormat::BinaryLittleEndian:
        return read_body<BinaryRows<std::endian::little>>(*source, *header, path, options);
    case PlyFormat::BinaryBigEndian:
        return read_body<BinaryRows<std::endian::big>>(*source, *header, path, options);
    }
    return source->error("unreachable");
}

} // namespace ovc
