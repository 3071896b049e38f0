// SPDX-License-Identifier: Apache-2.0
// Objects: statements such as sphere { … } and union { … }, and what changes them.
#pragma once

#include "importers/pov/object.h"
#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Whether an object's keyword is next.
bool starts_object(const Token& token);

/// The object that comes next; its keyword is the next token.
ObjectPtr parse_object(Reader& reader);

/// light_source, from the { on; mesh and mesh2, likewise. Their modifiers are read too.
void parse_light_source(Reader& reader, Object& object);
void parse_mesh(Reader& reader, Object& object);
void parse_mesh2(Reader& reader, Object& object);

/// shape_implicit.cpp: from the { on, likewise.
void parse_blob(Reader& reader, Object& object);
void parse_quadric(Reader& reader, Object& object);
void parse_polynomial(Reader& reader, Object& object);
void parse_isosurface(Reader& reader, Object& object);

/// Modifiers up to the }, which is taken.
void parse_modifiers(Reader& reader, Object& object);

/// Moves the object and its texture.
void place(Object& object, const dmat4& by);

} // namespace ovc::pov
