// SPDX-License-Identifier: Apache-2.0
// Reads objects: statements such as sphere { … } and union { … }, and their modifiers.
#pragma once

#include "importers/pov/object.h"
#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Returns whether the token is an object's keyword.
bool starts_object(const Token& token);

/// Reads an object. Its keyword is the next token.
ObjectPtr parse_object(Reader& reader);

/// These read a light_source, a mesh or a mesh2 from behind its { on, modifiers and } included.
void parse_light_source(Reader& reader, Object& object);
void parse_mesh(Reader& reader, Object& object);
void parse_mesh2(Reader& reader, Object& object);

/// These do the same for implicit shapes; shape_implicit.cpp defines them.
void parse_blob(Reader& reader, Object& object);
void parse_quadric(Reader& reader, Object& object);
void parse_polynomial(Reader& reader, Object& object);
void parse_isosurface(Reader& reader, Object& object);

/// Reads an object's modifiers up to its } and takes the } as well.
void parse_modifiers(Reader& reader, Object& object);

/// Applies a transformation to the object, its texture, and its clips and bounds.
void place(Object& object, const dmat4& by);

} // namespace ovc::pov
