// SPDX-License-Identifier: Apache-2.0
// The fields of a scene, named once for writing and for reading: each_field(io, x) calls io(…) with
// them. A type without each_field is written as its bytes.
#pragma once

#include "core/scene.h"
#include "importers/file/files_read.h"

#include <concepts>

namespace ovc {

/// Matches T and const T.
template <class A, class T>
concept Some = std::same_as<std::remove_const_t<A>, T>;

void each_field(auto& io, Some<PlacedTexture> auto& p) {
    io(p.texture, p.to_texture);
}

void each_field(auto& io, Some<SlopeStop> auto& s) {
    io(s.at, s.height, s.slope);
}

void each_field(auto& io, Some<Bump> auto& b) {
    io(b.kind, b.amount, b.accuracy, b.keeps_depth, b.pattern, b.profile, b.parts);
}

void each_field(auto& io, Some<FormulaStep> auto& s) {
    io(s.kind, s.index, s.count, s.value);
}

void each_field(auto& io, Some<Formula> auto& f) {
    io(f.steps, f.ends);
}

void each_field(auto& io, Some<DensityGrid> auto& g) {
    io(g.size, g.values);
}

void each_field(auto& io, Some<PlacedRound> auto& r) {
    io(r.shape.base, r.shape.radius, r.shape.cap, r.shape.cap_radius, r.shape.is_ball, r.shape.open,
       r.to_shape);
}

void each_field(auto& io, Some<Region> auto& r) {
    io(r.triangles.corners, r.triangles.boxes, r.inverted, r.rounds, r.half_spaces);
}

void each_field(auto& io, Some<Finish> auto& f) {
    io(f.ambient, f.emission, f.diffuse, f.brilliance, f.phong, f.phong_size, f.specular,
       f.roughness, f.metallic, f.reflection, f.grazing_reflection, f.reflection_falloff, f.fresnel,
       f.metallic_reflection, f.conserve_energy, f.irid, f.irid_thickness, f.irid_turbulence,
       f.irid_noise, f.irid_wavelengths, f.crand, f.filter_by_brightest, f.diffuse_back);
}

void each_field(auto& io, Some<TransparentColor> auto& c) {
    io(c.rgb, c.filter, c.transmit);
}

void each_field(auto& io, Some<TextureStep> auto& s) {
    io(s.kind, s.rows);
}

void each_field(auto& io, Some<Octaves> auto& o) {
    io(o.lambda, o.omega, o.count);
}

void each_field(auto& io, Some<Pattern> auto& p) {
    io(p.kind, p.parameters, p.wave, p.frequency, p.phase, p.exponent, p.noise, p.turbulence,
       p.octaves, p.steps, p.formula, p.grid, p.region);
}

void each_field(auto& io, Some<TextureStop> auto& s) {
    io(s.at, s.color, s.texture);
}

/// An image is saved without its lookup: it is opened anew.
void each_field(auto& io, Some<ImageTexture> auto& i) {
    io(i.picture, i.projection, i.to_picture, i.beyond_s, i.beyond_t, i.filter, i.gamma, i.channel,
       i.per, i.window_distance, i.is_transparent, i.filter_all, i.transmit_all, i.scale, i.offset,
       i.otherwise);
}

void each_field(auto& io, Some<Texture> auto& t) {
    io(t.kind, t.on_uv, t.pattern, t.stops, t.image);
}

void each_field(auto& io, Some<NormalMap> auto& m) {
    io(m.kind, m.texture, m.scale);
}

void each_field(auto& io, Some<MaterialMaps> auto& m) {
    io(m.reflection, m.width, m.emission, m.metallic);
}

void each_field(auto& io, Some<PictureFile> auto& p) {
    io(p.file, p.asked_for_at, p.contents);
}

void each_field(auto& io, Some<Optics> auto& o) {
    io(o.diffuse, o.diffuse_behind, o.internal_reflection, o.boundary, o.reflection, o.through,
       o.ior, o.width, o.emission, o.two_sided);
}

void each_field(auto& io, Some<Radiosity> auto& r) {
    io(r.bounces, r.brightness);
}

void each_field(auto& io, Some<Absorption> auto& a) {
    io(a.distance, a.power, a.color);
}

void each_field(auto& io, Some<Medium> auto& m) {
    io(m.absorption, m.emission, m.scattering, m.extinction, m.phase, m.eccentricity, m.densities,
       m.intervals, m.samples, m.levels, m.threshold);
}

void each_field(auto& io, Some<Material> auto& m) {
    io(m.name, m.color, m.mirror, m.transmission, m.filter, m.ior, m.finish, m.optics, m.texture,
       m.bump, m.normal_map, m.maps, m.under, m.absorption, m.media, m.hollow, m.caustics, m.inside,
       m.mix);
}

void each_field(auto& io, Some<Cutout> auto& c) {
    io(c.width, c.height, c.opacity, c.scale, c.uv_scale, c.uv_offset, c.beyond, c.smooth,
       c.partial, c.texture, c.threshold);
}

void each_field(auto& io, Some<SpotCone> auto& c) {
    io(c.radius_cosine, c.falloff_cosine, c.tightness);
}

void each_field(auto& io, Some<LightBeam> auto& b) {
    io(b.radius, b.falloff, b.tightness);
}

void each_field(auto& io, Some<ThrownPicture> auto& t) {
    io(t.texture, t.has_window);
}

void each_field(auto& io, Some<Light> auto& l) {
    io(l.position, l.color, l.shadow_offset, l.faces_places, l.area_points, l.clearance, l.group,
       l.on_camera, l.direction, l.cone, l.beam, l.parallel, l.distant, l.shadowless,
       l.lights_media, l.fades_in_air, l.fade_distance, l.fade_power, l.stand_in, l.projector,
       l.thrown);
}

void each_field(auto& io, Some<ImageWindow> auto& w) {
    io(w.direction, w.right, w.up, w.orthographic, w.bend, w.angle, w.vertical_angle, w.shape);
}

void each_field(auto& io, Some<Camera> auto& c) {
    io(c.eye, c.target, c.up, c.fov_degrees, c.fov_is_upright, c.window, c.bump, c.lens, c.nearest,
       c.by_faces);
}

void each_field(auto& io, Some<FaceMesh> auto& m) {
    io(m.corners, m.normals, m.uv);
}

void each_field(auto& io, Some<FaceCamera> auto& c) {
    io(c.order, c.meshes, c.ahead, c.backwards);
}

void each_field(auto& io, Some<ImageSize> auto& s) {
    io(s.width, s.height);
}

void each_field(auto& io, Some<Fog> auto& f) {
    io(f.color, f.distance, f.altitude, f.offset, f.up, f.turbulence, f.turbulence_depth, f.octaves,
       f.noise);
}

void each_field(auto& io, Some<Rainbow> auto& r) {
    io(r.direction, r.up, r.angle, r.width, r.distance, r.arc, r.full_arc, r.jitter, r.colors);
}

void each_field(auto& io, Some<Background> auto& b) {
    io(b.horizon, b.zenith, b.layers, b.tints, b.layers_add, b.fogs, b.rainbows, b.media);
}

void each_field(auto& io, Some<Omission> auto& o) {
    io(o.sentence, o.count);
}

void each_field(auto& io, Some<Instancing> auto& i) {
    io(i.unique_triangles, i.instances);
}

/// Passes all fields except the normals and texture coordinates, which are parts of their own in
/// the file.
void each_field(auto& io, Some<MeshInfo> auto& m) {
    io(m.name, m.material, m.lit_by.group, m.lit_by.group_alone, m.curved, m.normals_from, m.turn,
       m.cutout, m.shadow_cutout, m.uv_from, m.normals_left_out, m.texture_coordinates_left_out);
}

/// Passes all fields except meshes, soup, and what the file's other parts hold.
void each_field(auto& io, Some<Scene> auto& s) {
    io(s.name, s.materials, s.textures, s.pictures, s.bumps, s.cutouts, s.lights, s.may_add_light,
       s.camera, s.faces, s.size, s.part, s.max_depth, s.samples, s.background, s.radiosity,
       s.exposure, s.gamma, s.omissions, s.instancing);
}

void each_field(auto& io, Some<FileStamp> auto& f) {
    io(f.path, f.exists, f.bytes, f.time_ns);
}

} // namespace ovc
