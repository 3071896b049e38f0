// SPDX-License-Identifier: Apache-2.0
// The words of an answer in the frame of the whole scene, or of a leaf (layout.h).

uvec4 frame_answer(Found found, bool any_hit) {
    if (OVC_CERTIFY == 0)
        return uvec4(floatBitsToUint(vec3(found.best_lo, barycentric(found))), found.prim);
    uvec4 answer = answer_of(found, any_hit, 0u);
    answer.w = answer.w == OVC_ENDED ? OVC_FLAGGED : answer.w;
    return answer;
}
uvec4 frame_answer(Found found) { return frame_answer(found, OVC_ANY_HIT != 0); }
