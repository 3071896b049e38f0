// SPDX-License-Identifier: Apache-2.0
// Source: Khronos, "glTF 2.0", sections 3 and 4 (the binary container), and its registry of
// extensions.
#include "importers/mesh/gltf.h"

#include "importers/file/text.h"
#include "importers/mesh/gltf_extents.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>

namespace ovc {

namespace {

using Json = nlohmann::json;

/// The max depth of the JSON, whose readers are recursive; files have about ten levels.
constexpr int kMaxDepth = 200;

/// The extensions that are shown. assimp_look.cpp reads what Assimp makes of them. Assimp says
/// where it was built without Draco.
constexpr std::string_view kDraco = "KHR_draco_mesh_compression",
                           kStrength = "KHR_materials_emissive_strength";
constexpr std::string_view kShown[] = {kDraco,
                                       "KHR_lights_punctual",
                                       kStrength,
                                       "KHR_materials_ior",
                                       "KHR_materials_transmission",
                                       "KHR_texture_transform"};

/// The extensions without which a file that does not require them means the same.
constexpr std::string_view kNeedless[] = {"EXT_meshopt_compression", "KHR_mesh_quantization",
                                          "KHR_xmp_json_ld"};

bool is_among(std::string_view name, std::span<const std::string_view> names) {
    return std::ranges::find(names, name) != names.end();
}

/// The container of a binary file: a header of three numbers, then chunks of a length, a type and
/// as many bytes. The first chunk is the JSON.
constexpr std::string_view kMagic = "glTF", kJsonChunk = "JSON";
constexpr size_t kHeaderBytes = 12, kChunkBytes = 8;

uint32_t number_at(std::string_view bytes, size_t at) {
    static_assert(std::endian::native == std::endian::little);
    uint32_t number = 0;
    std::memcpy(&number, bytes.data() + at, sizeof(number));
    return number;
}

std::string bytes_of(size_t number) {
    const auto narrow = uint32_t(number);
    return {reinterpret_cast<const char*>(&narrow), sizeof(narrow)};
}

/// The place of the JSON in the file.
struct Span {
    size_t first, count;
};

/// Returns a sentence on why the container holds no JSON in full; nothing if it does.
std::optional<std::string> container_fault(std::string_view all) {
    if (all.size() < kHeaderBytes + kChunkBytes)
        return fmt::format("found {} bytes, expected a binary glTF file of {} or more", all.size(),
                           kHeaderBytes + kChunkBytes);
    if (all.substr(kHeaderBytes + 4, 4) != kJsonChunk)
        return fmt::format("found a chunk {}, expected {}",
                           ovc::quoted(all.substr(kHeaderBytes + 4, 4)), ovc::quoted(kJsonChunk));
    if (const size_t length = number_at(all, 8); length > all.size())
        return fmt::format("found {} bytes, expected {}, as its header says", all.size(), length);
    if (const size_t length = number_at(all, kHeaderBytes);
        length > all.size() - kHeaderBytes - kChunkBytes)
        return fmt::format("found {} bytes, expected JSON of {}", all.size(), length);
    return std::nullopt;
}

std::string with_json(std::string_view all, Span at, std::string json) {
    json.append((4 - json.size() % 4) % 4, ' ');
    const std::string_view rest = all.substr(at.first + at.count);
    const size_t length = kHeaderBytes + kChunkBytes + json.size() + rest.size();
    return fmt::format("{}{}{}{}{}{}{}", kMagic, bytes_of(2), bytes_of(length),
                       bytes_of(json.size()), kJsonChunk, json, rest);
}

/// Says where the JSON ends to be any. byte: of the last character that was read, from 1.
Error json_error(const Source& source, std::string_view text, size_t byte) {
    const size_t last = std::min(byte == 0 ? 0 : byte - 1, text.size());
    const std::string_view before = text.substr(0, last);
    const auto line = uint64_t(std::ranges::count(before, '\n')) + 1;
    const size_t column = last - (before.rfind('\n') + 1) + 1; // npos + 1 is 0
    const std::string found =
        last == text.size() ? "the end of the file" : ovc::quoted(text.substr(last, 1));
    return source.error_at_line(
        line, fmt::format("found {} in column {}, expected JSON to go on", found, column));
}

Result<Json> parsed(const Source& source, std::string_view text) {
    bool is_too_deep = false;
    const auto limit = [&](int depth, Json::parse_event_t, Json&) {
        is_too_deep = is_too_deep || depth > kMaxDepth;
        return !is_too_deep;
    };
    try {
        Json json = Json::parse(text, limit);
        if (is_too_deep)
            return source.error(
                fmt::format("found JSON more than {} levels deep, expected fewer", kMaxDepth));
        if (!json.is_object())
            return source.error("found JSON that is no object, expected a glTF file");
        return json;
    } catch (const Json::parse_error& e) {
        return json_error(source, text, e.byte);
    }
}

/// Returns json[name], if it is an array; else an empty one.
const Json& array(const Json& json, const char* name) {
    static const Json none = Json::array();
    const auto at = json.is_object() ? json.find(name) : json.end();
    return at != json.end() && at->is_array() ? *at : none;
}

constexpr int kUnsigned16 = 5123, kFloat = 5126; // a componentType each
constexpr uint64_t kMaxUnsigned16 = 65535;

/// Returns the accessor of that index, or null if the file has none there.
const Json* accessor_at(const Json& gltf, const Json& index) {
    const Json& accessors = array(gltf, "accessors");
    if (!index.is_number_unsigned() || index.get<uint64_t>() >= accessors.size())
        return nullptr;
    const Json& accessor = accessors[index.get<size_t>()];
    return accessor.is_object() ? &accessor : nullptr;
}

bool is_of_floats(const Json& accessor) {
    return accessor.value("componentType", Json()) == kFloat;
}

/// Returns the value at `path`, or null if there is none.
Json* value_at(Json& json, const Json::json_pointer& path) {
    return json.contains(path) ? &json[path] : nullptr;
}

/// Parts of a file that are not shown.
class Omissions {
public:
    explicit Omissions(Json& gltf) : gltf_(gltf) {}

    /// Returns the extension that the file cannot be read without; none if all are known.
    std::optional<std::string> missing_extension() {
        for (const Json& name : array(gltf_, "extensionsRequired"))
            if (name.is_string() && !is_among(name.get<std::string>(), kShown) &&
                !name.get<std::string>().starts_with("KHR_materials_"))
                return name.get<std::string>();
        return std::nullopt;
    }

    /// Takes it out of the file, and returns a sentence on each kind.
    std::vector<std::string> take_out() {
        name_extensions();
        if (const size_t scenes = array(gltf_, "scenes").size(); scenes > 1)
            count(scenes - 1, "more scene");
        count(array(gltf_, "animations").size(), "animation", ": what moves is shown at rest");
        gltf_.erase("animations");
        for (const char* name : {"nodes", "meshes"})
            for (Json& each : all(gltf_, name))
                note_deformation(each);
        count(skinned_, "skin", ": meshes are shown in their rest form");
        gltf_.erase("skins");
        count(morphed_, "set of morph weights", ": meshes are shown in their rest form");
        for (Json& mesh : all(gltf_, "meshes"))
            for (Json& primitive : all(mesh, "primitives"))
                take_out_of(primitive);
        count(colored_, "set of vertex colors");
        count(uneven_, "set of texture coordinates", ": they are no floats");
        return std::move(sentences_);
    }

    bool has_long_draco() const { return has_long_draco_; }

private:
    /// Returns the members of an array that are objects.
    static std::vector<std::reference_wrapper<Json>> all(Json& json, const char* name) {
        std::vector<std::reference_wrapper<Json>> objects;
        if (json.contains(name) && json[name].is_array())
            for (Json& each : json[name])
                if (each.is_object())
                    objects.push_back(each);
        return objects;
    }

    void count(uint64_t number, std::string_view what, std::string_view more = {}) {
        if (number > 0)
            sentences_.push_back(fmt::format("{} left out{}", counted(number, what), more));
    }

    /// Tells Assimp of the extensions that there are, which some files do not declare.
    void name_extensions() {
        std::set<std::string> names;
        gather_extensions(gltf_, names);
        gltf_["extensionsUsed"] = names;
        for (const std::string& name : names)
            if (!is_among(name, kShown) && !is_among(name, kNeedless))
                sentences_.push_back(fmt::format("the extension {} left out", ovc::quoted(name)));
    }

    /// Adds the names of the extensions that parts of the file have.
    static void gather_extensions(const Json& part, std::set<std::string>& names) {
        for (const auto& [key, value] : part.items()) {
            if (part.is_object() && key == "extensions" && value.is_object())
                for (const auto& extension : value.items())
                    names.insert(extension.key());
            if (value.is_structured() && key != "extras")
                gather_extensions(value, names);
        }
    }

    /// of: a node or a mesh; either may have weights.
    void note_deformation(Json& of) {
        const Json& weights = array(of, "weights");
        morphed_ += std::ranges::any_of(
            weights, [](const Json& w) { return w.is_number() && w.get<double>() != 0; });
        skinned_ += of.contains("skin");
        of.erase("weights");
        of.erase("skin");
    }

    /// Assimp 5 takes the bytes of all positions, normals and texture coordinates for floats.
    void take_out_of(Json& primitive) {
        primitive.erase("targets");
        if (!primitive.contains("attributes") || !primitive["attributes"].is_object())
            return;
        Json& attributes = primitive["attributes"];
        bool is_even = true;
        for (const auto& [name, index] : attributes.items()) {
            colored_ += name == "COLOR_0";
            const Json* const accessor = accessor_at(gltf_, index);
            is_even =
                is_even && (!name.starts_with("TEXCOORD_") || !accessor || is_of_floats(*accessor));
        }
        uneven_ += !is_even;
        const auto take_out_attributes = [&](Json& of) {
            for (auto at = of.begin(); at != of.end();) {
                const bool stays = at.key() == "POSITION" || at.key() == "NORMAL" ||
                                   (is_even && at.key().starts_with("TEXCOORD_"));
                at = stays ? std::next(at) : of.erase(at);
            }
        };
        take_out_attributes(attributes);
        const Json::json_pointer draco = Json::json_pointer("/extensions") / std::string(kDraco);
        if (Json* const packed = value_at(primitive, draco / "attributes");
            packed && packed->is_object()) {
            take_out_attributes(*packed);
            shorten_indices(primitive);
        }
    }

    /// Assimp 5.2 loses what Draco unpacks as indices of 32 bits.
    void shorten_indices(Json& primitive) {
        Json* const positions = value_at(primitive, Json::json_pointer("/attributes/POSITION"));
        Json* const indices = value_at(primitive, Json::json_pointer("/indices"));
        const Json* const vertices = positions ? accessor_at(gltf_, *positions) : nullptr;
        if (!vertices || !indices || !accessor_at(gltf_, *indices))
            return;
        if (vertices->value("count", uint64_t(0)) > kMaxUnsigned16 + 1)
            has_long_draco_ = true;
        else
            gltf_["accessors"][indices->get<size_t>()]["componentType"] = kUnsigned16;
    }

    Json& gltf_;
    bool has_long_draco_ = false;
    std::vector<std::string> sentences_;
    uint64_t skinned_ = 0, morphed_ = 0, colored_ = 0, uneven_ = 0;
};

/// Returns a sentence on the first position or normal that is not kept in floats.
std::optional<std::string> uneven_vertex(const Json& gltf) {
    for (const Json& mesh : array(gltf, "meshes"))
        for (const Json& primitive : array(mesh, "primitives"))
            for (const char* name : {"POSITION", "NORMAL"}) {
                if (!primitive.is_object())
                    continue;
                const Json index =
                    primitive.value(Json::json_pointer("/attributes") / name, Json());
                const Json* const accessor = accessor_at(gltf, index);
                if (accessor &&
                    (!is_of_floats(*accessor) || accessor->value("type", Json()) != "VEC3"))
                    return fmt::format("found {} in accessors[{}], which is no VEC3 of floats",
                                       name, index.get<size_t>());
            }
    return std::nullopt;
}

/// Multiplies the light of materials by KHR_materials_emissive_strength, which Assimp 5 passes
/// over.
void strengthen_light(Json& gltf) {
    const auto extension = Json::json_pointer("/extensions") / std::string(kStrength);
    Json* const materials = value_at(gltf, Json::json_pointer("/materials"));
    for (size_t m = 0; materials && materials->is_array() && m < materials->size(); ++m) {
        Json& material = (*materials)[m];
        const Json* const strength = value_at(material, extension / "emissiveStrength");
        Json* const factor = value_at(material, Json::json_pointer("/emissiveFactor"));
        if (!strength || !strength->is_number())
            continue;
        for (size_t c = 0; factor && factor->is_array() && c < factor->size(); ++c)
            if ((*factor)[c].is_number())
                (*factor)[c] = (*factor)[c].get<double>() * strength->get<double>();
        material["extensions"].erase(std::string(kStrength));
    }
}

/// Decodes the names of files, which are URIs: Assimp opens them as they stand.
void name_files(Json& gltf) {
    Json* const buffers = value_at(gltf, Json::json_pointer("/buffers"));
    for (size_t b = 0; buffers && buffers->is_array() && b < buffers->size(); ++b)
        if (Json* const uri = value_at((*buffers)[b], Json::json_pointer("/uri"));
            uri && uri->is_string() && !uri->get<std::string>().starts_with("data:"))
            *uri = decoded_uri(uri->get<std::string>());
}

/// Shows all nodes of a file that has no scene: Assimp refuses it.
void make_scene(Json& gltf) {
    if (!array(gltf, "scenes").empty())
        return;
    std::vector<bool> is_child(array(gltf, "nodes").size());
    for (const Json& node : array(gltf, "nodes"))
        for (const Json& child : array(node, "children"))
            if (child.is_number_unsigned() && child.get<uint64_t>() < is_child.size())
                is_child[child.get<size_t>()] = true;
    Json roots = Json::array();
    for (size_t n = 0; n < is_child.size(); ++n)
        if (!is_child[n])
            roots.push_back(n);
    gltf["scenes"] = Json::array({{{"nodes", std::move(roots)}}});
    gltf["scene"] = 0;
}

/// Gives each node a name of its own, and a camera and a light of its own where others have the
/// same ones: Assimp keeps one place for each of them, which it finds by the node's name.
void tell_nodes_apart(Json& gltf) {
    const std::pair<Json::json_pointer, Json::json_pointer> kShared[] = {
        {Json::json_pointer("/camera"), Json::json_pointer("/cameras")},
        {Json::json_pointer("/extensions/KHR_lights_punctual/light"),
         Json::json_pointer("/extensions/KHR_lights_punctual/lights")}};
    Json* const nodes = value_at(gltf, Json::json_pointer("/nodes"));
    for (size_t n = 0; nodes && n < nodes->size(); ++n)
        if ((*nodes)[n].is_object())
            (*nodes)[n]["name"] = fmt::format("nodes[{}]", n);
    for (const auto& [of_node, of_file] : kShared) {
        Json* const things = value_at(gltf, of_file);
        std::set<uint64_t> taken;
        for (size_t n = 0; things && things->is_array() && nodes && n < nodes->size(); ++n) {
            Json* const index = value_at((*nodes)[n], of_node);
            if (!index || !index->is_number_unsigned() || *index >= things->size() ||
                taken.insert(index->get<uint64_t>()).second)
                continue;
            things->push_back((*things)[index->get<size_t>()]);
            *index = things->size() - 1;
        }
    }
}

/// Returns the version that the file is of; nothing if it does not say.
std::string version_of(const Json& gltf) {
    const Json version = gltf.value(Json::json_pointer("/asset/version"), Json());
    return version.is_string() ? version.get<std::string>() : std::string();
}

} // namespace

Result<GltfFile> read_gltf_file(Source& source) {
    GltfFile file;
    file.bytes = source.rest();
    if (source.is_damaged())
        return source.error("");
    const std::string_view all = file.bytes;
    file.is_binary = all.starts_with(kMagic);
    if (file.is_binary && all.size() >= 8 && number_at(all, 4) == 1)
        return file;
    Span at{0, all.size()};
    if (file.is_binary) {
        if (const auto fault = container_fault(all))
            return source.error(*fault);
        at = {kHeaderBytes + kChunkBytes, number_at(all, kHeaderBytes)};
    }
    Result<Json> gltf = parsed(source, all.substr(at.first, at.count));
    if (!gltf)
        return gltf.error();
    const std::string version = version_of(*gltf);
    if (version.starts_with("1"))
        return file;
    if (!version.starts_with("2"))
        return source.error(fmt::format("{}, expected glTF of version 2.0",
                                        version.empty() ? "found no version"
                                                        : "found version " + ovc::quoted(version)));
    Omissions omissions(*gltf);
    if (const auto name = omissions.missing_extension())
        return source.error(fmt::format("found the required extension {}, expected none but {}",
                                        ovc::quoted(*name), fmt::join(kShown, ", ")));
    auto fault = unsound_extent(*gltf);
    fault = fault ? fault : uneven_vertex(*gltf);
    if (fault)
        return source.error(*fault);
    file.left_out = omissions.take_out();
    file.has_long_draco = omissions.has_long_draco();
    tell_nodes_apart(*gltf);
    strengthen_light(*gltf);
    name_files(*gltf);
    make_scene(*gltf);
    std::string json = gltf->dump();
    file.bytes = file.is_binary ? with_json(all, at, std::move(json)) : std::move(json);
    return file;
}

} // namespace ovc
