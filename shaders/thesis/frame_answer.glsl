// SPDX-License-Identifier: Apache-2.0
// The words of an answer in the frame of the whole scene (layout.h).

uvec4 frame_answer(Found found) {
    if (OVC_CERTIFY == 0)
        return uvec4(floatBitsToUint(vec3(found.best_lo, barycentric(found))), found.prim);
    return answer_of(found, OVC_ANY_HIT != 0, 0u);
}
