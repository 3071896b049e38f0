// SPDX-License-Identifier: Apache-2.0
// Makes one triangle that covers the viewport. It takes no inputs.
#version 450 core

void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
