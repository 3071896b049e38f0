// SPDX-License-Identifier: Apache-2.0
// The OBJ reader streams polygons, normals and materials, and makes one mesh per object, group and
// material.
// Source: Wavefront, "Advanced Visualizer" manual, appendix B1 (the Object files format).
#include "core/file/triangle_sink.h"
#include "importers/file/source.h"
#include "importers/file/text.h"
#include "importers/mesh/blocks.h"
#include "importers/mesh/obj/obj_materials.h"
#include "importers/mesh/polygon.h"
#include "importers/origin.h"
#include "importers/readers.h"
#include "importers/scratch/scratch_array.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <unordered_map>
#include <unordered_set>

namespace ovc {

namespace {

/// Meshes farther from 0 than this many extents get an origin, because single precision would cost
/// more than the last digit that files carry.
constexpr double kFar = 16;

struct Corner {
    size_t vertex = 0;
    int64_t normal = -1;     // index; -1 if none is stated; may be out of range
    int64_t uv = -1;         // likewise, where texture coordinates are kept
    bool has_normal = false; // the file states one, though it may not exist
    bool has_texture = false;
};

struct Mesh {
    std::string name;
    uint32_t material = 0;
    Blocks<vec3> corners;
    Blocks<vec3> normals; // as many as corners, while has_normals
    Blocks<vec2> uv;      // as many as all corners, while wants_uv
    bool has_normals = true;
    bool wants_uv = false;                                // a texture of its material lies on them
    uint64_t normals_stated = 0, texture_coordinates = 0; // counted in corners
    uint64_t passed_on = 0;                               // corners that a sink has got
};

/// How the host memory that a stream may take is shared out. Corners wait for the sink, and exist
/// twice while they are handed on.
struct Shares {
    uint64_t vertices, normals, uv, waiting, meshes;

    explicit Shares(uint64_t bytes)
        : vertices(bytes / 2),
          normals(bytes / 8),
          uv(bytes / 16),
          waiting(bytes / 16),
          meshes(bytes / 4) {}
};

constexpr size_t kPartOfMesh = 1 << 16; // corners of a mesh that are handed on at once, or more
constexpr uint64_t kUnlimited = ~uint64_t(0);

class ObjReader {
public:
    ObjReader(Source& source, const std::filesystem::path& path, const ImportOptions& options)
        : source_(source),
          path_(path),
          log_(options.log),
          streaming_(options.streaming),
          materials_(path, options),
          shares_(streaming_ ? streaming_->host_bytes : kUnlimited),
          vertices_(streaming_ ? streaming_->folder : "", shares_.vertices),
          normals_(streaming_ ? streaming_->folder : "", shares_.normals),
          uv_(streaming_ ? streaming_->folder : "", shares_.uv) {}

    bool read() {
        while (const auto line = source_.line()) {
            if (source_.line_number() == 1 && !check_encoding(*line))
                return false;
            if (!read_line(joined(*line)))
                return false;
        }
        if (source_.is_damaged())
            return fail("");
        return !streaming_ || pass_on_all();
    }

    Error error() const { return is_wanted_ ? error_ : Error{"cancelled", ErrorKind::Cancelled}; }
    Result<Scene> take();

private:
    bool fail(std::string_view sentence) {
        error_ = source_.error_at_line(sentence);
        return false;
    }

    /// Says the sentence at the first call with this kind only.
    void warn(const std::string& kind, const std::string& sentence) {
        if (warned_.insert(kind).second)
            say(log_, LogLevel::Warning, source_.error_at_line(sentence).message);
    }

    bool check_encoding(std::string_view line) {
        if (line.starts_with("\xfe\xff") || line.starts_with("\xff\xfe"))
            return fail("found UTF-16 text, expected ASCII or UTF-8");
        return true;
    }

    /// Returns the line and, while it ends in a backslash, the lines that continue it.
    std::string_view joined(std::string_view line);
    bool read_line(std::string_view line);
    bool read_other(std::string_view keyword, std::string_view rest);
    bool read_vertex(std::string_view rest);
    void note_colors(std::string_view rest);
    bool read_normal(std::string_view rest);
    bool read_uv(std::string_view rest);
    bool read_smoothing(std::string_view rest);
    bool read_face(std::string_view rest);
    bool read_corner(std::string_view word);
    bool read_index(std::string_view word, std::string_view text, size_t count, size_t& index);
    bool fail_index(int64_t index, size_t count);
    bool find_mesh();
    bool add_mesh(std::string name);
    bool add_polygon();
    void cut_polygon(Mesh& to);
    void add_corner(Mesh& mesh, const Corner& corner);
    bool pass_on(size_t mesh);
    bool pass_on_all();
    bool check_scratch();

    Source& source_;
    const std::filesystem::path& path_;
    const LogSink& log_;
    const Streaming* const streaming_;
    ObjMaterials materials_;
    const Shares shares_;
    bool is_wanted_ = true; // by its sink
    Error error_;
    std::unordered_set<std::string> warned_;
    std::string joined_;

    ScratchArray<dvec3> vertices_;
    ScratchArray<vec3> normals_;
    ScratchArray<vec2> uv_; // while materials_.keeps_uv()
    bool has_uv_ = false;
    Box bounds_;
    std::optional<dvec3> origin_; // chosen from the vertices that precede the first face
    std::vector<Corner> polygon_;
    std::vector<dvec3> outline_;
    std::vector<std::array<uint32_t, 3>> cut_;

    uint32_t material_ = 0;
    std::string object_;
    std::string group_;
    std::vector<Mesh> meshes_;
    std::unordered_map<std::string, size_t> mesh_ids_;
    size_t mesh_ = 0;
    bool has_colors_ = false; // some vertex has
    bool is_smooth_ = false;  // faces are in a smoothing group
    bool mesh_known_ = false; // becomes false when object, group or material changes
    uint64_t waiting_ = 0;    // corners in all meshes that the sink has not got
};

std::string_view ObjReader::joined(std::string_view line) {
    if (line.empty() || line.back() != '\\')
        return line;
    joined_.clear();
    std::optional<std::string_view> next = line;
    while (next && !next->empty() && next->back() == '\\') {
        joined_.append(next->substr(0, next->size() - 1));
        joined_ += ' ';
        next = source_.line();
    }
    if (next)
        joined_.append(*next);
    return joined_;
}

bool ObjReader::read_line(std::string_view line) {
    const std::string_view keyword = next_word(line);
    if (keyword == "v")
        return read_vertex(line);
    if (keyword == "f" || keyword == "fo")
        return read_face(line);
    if (keyword == "vn")
        return read_normal(line);
    if (keyword == "vt")
        return read_uv(line);
    if (keyword == "s")
        return read_smoothing(line);
    return keyword.empty() || keyword[0] == '#' || read_other(keyword, line);
}

bool ObjReader::read_other(std::string_view keyword, std::string_view rest) {
    if (keyword == "o" || keyword == "g") {
        const std::string_view name = trimmed(without_comment(rest));
        if (keyword == "o")
            object_ = name;
        group_ = keyword == "g" ? name : "";
        mesh_known_ = false;
    } else if (keyword == "usemtl") {
        material_ = materials_.find(trimmed(rest), source_.line_number());
        mesh_known_ = false;
    } else if (keyword == "mtllib") {
        const Result<Done> done = materials_.read_libraries(
            trimmed(rest), has_uv_, [&](auto& kind, auto& sentence) { warn(kind, sentence); });
        if (!done)
            error_ = done.error();
        return bool(done);
    } else {
        for (const char c : keyword)
            if (c < ' ' || c > '~')
                return fail(fmt::format("found {}, expected v, vn, vt, f, o, g, usemtl, mtllib or "
                                        "another statement of the OBJ format",
                                        quoted(keyword)));
        warn(std::string(keyword), fmt::format("statements {} left out", quoted(keyword)));
    }
    return true;
}

bool ObjReader::read_vertex(std::string_view rest) {
    dvec3 position(0);
    for (int axis = 0; axis < 3; ++axis) {
        const std::string_view word = next_word(rest);
        const auto value = parse_double(word);
        if (!value)
            return fail(fmt::format("found {}, expected a coordinate", found(word)));
        position[axis] = *value;
    }
    if (!has_colors_ && !rest.empty())
        note_colors(rest);
    if (is_finite(position))
        bounds_.add(position);
    vertices_.push_back(position);
    return true;
}

/// Three numbers behind the position are a color; one is a weight.
void ObjReader::note_colors(std::string_view rest) {
    for (int i = 0; i < 3; ++i)
        if (!parse_float(next_word(rest)))
            return;
    has_colors_ = true;
    warn("vertex colors", "vertex colors left out");
}

bool ObjReader::read_normal(std::string_view rest) {
    vec3 normal(0);
    for (int axis = 0; axis < 3; ++axis) {
        const std::string_view word = next_word(rest);
        const auto value = parse_float(word);
        if (!value)
            return fail(fmt::format("found {}, expected a coordinate", found(word)));
        normal[axis] = *value;
    }
    const float length = glm::length(normal);
    // A zero marks a normal that cannot be used.
    if (!(length > 0) || !std::isfinite(length))
        normal = vec3(0);
    else if (std::abs(length - 1) > 1e-6f)
        normal /= length;
    normals_.push_back(normal);
    return true;
}

/// A word that is no number counts as 0: no mesh is refused for its texture coordinates.
bool ObjReader::read_uv(std::string_view rest) {
    has_uv_ = true;
    if (!materials_.keeps_uv())
        return true;
    const float u = parse_float(next_word(rest)).value_or(0);
    const float v = parse_float(next_word(rest)).value_or(0);
    uv_.push_back({std::isfinite(u) ? u : 0, std::isfinite(v) ? v : 0});
    return true;
}

bool ObjReader::read_smoothing(std::string_view rest) {
    const std::string_view group = next_word(rest);
    is_smooth_ = !group.empty() && group != "off" && group != "0";
    return true;
}

bool ObjReader::read_face(std::string_view rest) {
    polygon_.clear();
    for (std::string_view word = next_word(rest); !word.empty() && word[0] != '#';
         word = next_word(rest))
        if (!read_corner(word))
            return false;
    if (polygon_.size() < 3)
        warn("f", "faces with fewer than three corners left out");
    else
        return add_polygon();
    return true;
}

/// Reads v, v/vt, v//vn or v/vt/vn.
bool ObjReader::read_corner(std::string_view word) {
    Corner corner;
    const size_t slash = word.find('/');
    if (!read_index(word, word.substr(0, slash), vertices_.size(), corner.vertex))
        return false;
    const size_t second = slash == word.npos ? word.npos : word.find('/', slash + 1);
    if (second != word.npos && second + 1 < word.size()) {
        const auto normal = parse_number<int64_t>(word.substr(second + 1));
        if (!normal)
            return fail(
                fmt::format("found corner {}, expected v, v/vt, v//vn or v/vt/vn", quoted(word)));
        corner.normal = *normal > 0 ? *normal - 1 : int64_t(normals_.size()) + *normal;
        corner.has_normal = true;
    }
    corner.has_texture = has_uv_ && slash != word.npos && slash + 1 < std::min(second, word.size());
    if (corner.has_texture && materials_.keeps_uv()) {
        const std::string_view text = word.substr(slash + 1, second - slash - 1);
        const int64_t uv = parse_number<int64_t>(text).value_or(0);
        corner.uv = uv > 0 ? uv - 1 : int64_t(uv_.size()) + uv;
    }
    polygon_.push_back(corner);
    return true;
}

bool ObjReader::fail_index(int64_t index, size_t count) {
    return fail(fmt::format("found vertex {}, expected {}", index,
                            count == 0   ? "none, for none is above this line"
                            : count == 1 ? "the one above this line"
                                         : fmt::format("one of the {} above this line", count)));
}

/// Reads an index that counts from 1, or backwards from -1, the last vertex so far.
bool ObjReader::read_index(std::string_view word, std::string_view text, size_t count,
                           size_t& index) {
    const auto value = parse_number<int64_t>(text);
    if (!value)
        return fail(
            fmt::format("found corner {}, expected v, v/vt, v//vn or v/vt/vn", quoted(word)));
    const int64_t from_zero = *value > 0 ? *value - 1 : int64_t(count) + *value;
    if (*value == 0 || from_zero < 0 || from_zero >= int64_t(count))
        return fail_index(*value, count);
    index = size_t(from_zero);
    return true;
}

/// Makes mesh_ that of the object, group and material at hand.
bool ObjReader::find_mesh() {
    if (!mesh_known_) {
        std::string name = object_;
        if (!name.empty() && !group_.empty())
            name += '/';
        name += group_;
        const auto [at, is_new] =
            mesh_ids_.try_emplace(fmt::format("{}\n{}", material_, name), meshes_.size());
        if (is_new && !add_mesh(std::move(name)))
            return false;
        mesh_ = at->second;
        mesh_known_ = true;
    }
    assert(mesh_ < meshes_.size() && meshes_[mesh_].material == material_);
    return true;
}

bool ObjReader::add_mesh(std::string name) {
    if (streaming_ && (meshes_.size() + 1) * kMeshBytes > shares_.meshes)
        return fail(fmt::format("found more than {} objects, groups and materials, which take {} "
                                "bytes of host memory each, and may take a quarter of {}",
                                meshes_.size(), kMeshBytes, streaming_->host_bytes));
    meshes_.emplace_back();
    meshes_.back().name = std::move(name);
    meshes_.back().material = material_;
    meshes_.back().wants_uv = materials_.keeps_uv() && materials_.has_textures(material_);
    if (streaming_)
        streaming_->sink.begin_mesh();
    return true;
}

bool ObjReader::add_polygon() {
    if (!origin_)
        origin_ = chunk_origin(bounds_, kFar);
    if (!find_mesh())
        return false;
    if (is_smooth_ && !polygon_[0].has_normal)
        warn("s", "smoothing groups left out: faces without normals are flat");
    Mesh& to = meshes_[mesh_];
    const size_t before = to.corners.size();
    if (polygon_.size() == 3)
        for (const Corner& corner : polygon_)
            add_corner(to, corner);
    else
        cut_polygon(to);
    if (!streaming_)
        return true;
    waiting_ += to.corners.size() - before;
    if (to.corners.size() >= kPartOfMesh)
        return pass_on(mesh_);
    return waiting_ * 2 * sizeof(vec3) < shares_.waiting || pass_on_all();
}

void ObjReader::cut_polygon(Mesh& to) {
    outline_.clear();
    for (const Corner& corner : polygon_)
        outline_.push_back(vertices_[corner.vertex]);
    cut_.clear();
    triangulate(outline_, cut_);
    for (const auto& triangle : cut_)
        for (const uint32_t i : triangle)
            add_corner(to, polygon_[i]);
}

void ObjReader::add_corner(Mesh& to, const Corner& corner) {
    assert(origin_ && corner.vertex < vertices_.size());
    to.corners.push_back(vec3(vertices_[corner.vertex] - *origin_));
    to.normals_stated += corner.has_normal;
    to.texture_coordinates += corner.has_texture;
    if (to.wants_uv) {
        const bool is_there = corner.uv >= 0 && corner.uv < int64_t(uv_.size());
        to.uv.push_back(is_there ? uv_[size_t(corner.uv)] : vec2(0));
    }
    if (!to.has_normals)
        return;
    const bool exists = corner.normal >= 0 && corner.normal < int64_t(normals_.size());
    const vec3 normal = exists ? normals_[size_t(corner.normal)] : vec3(0);
    if (normal != vec3(0)) {
        to.normals.push_back(normal);
        return;
    }
    if (corner.normal != -1 || to.normals.size() + to.passed_on > 0)
        warn("vn", "normals left out where a corner of the mesh has none that can be used");
    to.has_normals = false;
    to.normals = {};
    if (streaming_)
        streaming_->sink.drop_normals(mesh_);
}

/// Hands the corners and normals of a mesh to the sink.
bool ObjReader::pass_on(size_t mesh) {
    Mesh& from = meshes_[mesh];
    const std::vector<vec3> corners = from.corners.take(), normals = from.normals.take();
    from.passed_on += corners.size();
    waiting_ -= corners.size();
    streaming_->sink.go_on_with(mesh);
    is_wanted_ = streaming_->sink.add_corners(corners) &&
                 (normals.empty() || streaming_->sink.add_normals(normals));
    return is_wanted_ && check_scratch();
}

bool ObjReader::pass_on_all() {
    for (size_t mesh = 0; mesh < meshes_.size(); ++mesh)
        if (meshes_[mesh].corners.size() > 0 && !pass_on(mesh))
            return false;
    return check_scratch();
}

bool ObjReader::check_scratch() {
    for (const Error* error : {vertices_.error(), normals_.error(), uv_.error()}) {
        if (!error)
            continue;
        error_ = *error;
        return false;
    }
    return true;
}

Result<Scene> ObjReader::take() {
    vertices_.clear();
    normals_.clear();
    uv_.clear();
    Scene scene;
    scene.name = path_.stem().string();
    std::vector<bool> used(materials_.size());
    for (const Mesh& mesh : meshes_)
        used[mesh.material] = true;
    const std::vector<uint32_t> cutouts = materials_.add_to(scene, used);
    bool has_triangles = false;
    for (Mesh& m : meshes_) {
        assert(m.normals.size() == (m.has_normals ? m.corners.size() : 0));
        const uint64_t triangles = (m.passed_on + m.corners.size()) / 3;
        has_triangles = has_triangles || triangles > 0;
        if (triangles > kMaxTriangles)
            return source_.error(fmt::format("found {} triangles in one mesh, expected at most {}",
                                             triangles, kMaxTriangles));
        scene.add_mesh(m.name.empty() ? scene.name : std::move(m.name), m.material,
                       Chunk::owning(origin_.value_or(dvec3(0)), m.corners.take()),
                       m.normals.take());
        MeshInfo& mesh = scene.meshes.back();
        mesh.normals_left_out = m.has_normals ? 0 : m.normals_stated;
        if (m.wants_uv && m.texture_coordinates > 0) {
            mesh.uv = m.uv.take();
            mesh.cutout = cutouts[m.material];
        } else {
            mesh.texture_coordinates_left_out = m.texture_coordinates;
        }
    }
    materials_.say_left_out(used, source_);
    if (!has_triangles)
        say(log_, LogLevel::Warning, source_.error("it has no triangles").message);
    return scene;
}

} // namespace

Result<Scene> read_obj(const std::filesystem::path& path, const ImportOptions& options) {
    Result<Source> source = Source::open(path, options.files);
    if (!source)
        return source.error();
    ObjReader reader(*source, path, options);
    if (!reader.read())
        return reader.error();
    return reader.take();
}

} // namespace ovc
