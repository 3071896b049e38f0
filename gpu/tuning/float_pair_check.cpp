// SPDX-License-Identifier: Apache-2.0
#include "gpu/tuning/float_pair_check.h"

#include "gpu/gl/gl_check.h"
#include "gpu/gl/gl_object.h"
#include "gpu/gl/kernel.h"
#include "shaders/layout.h"

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace ovc {
namespace {

constexpr size_t kCases = 256; // a multiple of the kernel's group size

FloatPair pair_of(double value) {
    const auto hi = float(value);
    return {hi, float(value - double(hi))};
}

bool is(const FloatPair& pair, double exact) {
    const FloatPair expected = pair_of(exact);
    return pair.hi == expected.hi && pair.lo == expected.lo;
}
/// Whether the pair is off by at most so many u^2 of the exact number, and its parts do not
/// overlap.
bool is_near(const FloatPair& pair, double exact, double max_error) {
    return pair.hi == float(pair.value()) &&
           std::abs(pair.value() - exact) <= (max_error * 0x1p-48 + 0x1p-52) * std::abs(exact);
}

/// Sums and products of two floats are exact in doubles here, those of pairs nearly.
bool is_right(const FloatPairQuestion& q, const FloatPairAnswer& told) {
    return is(told.two_sum, double(q.a.hi) + double(q.b.hi)) &&
           is(told.two_product, double(q.a.hi) * double(q.b.hi)) &&
           is_near(told.sum, q.a.value() + q.b.value(), 3) &&
           is_near(told.product, q.a.value() * q.b.value(), 7);
}

gl::Handle<gl::delete_buffer> make_buffer(size_t bytes, const void* data) {
    gl::Handle<gl::delete_buffer> buffer(gl::create_buffer());
    glNamedBufferStorage(buffer.id(), GLsizeiptr(bytes), data, 0);
    return buffer;
}

} // namespace

std::vector<FloatPairQuestion> float_pair_questions() {
    std::mt19937 random(1);
    const auto number = [&] {
        const double mantissa = 1 + double(random()) * 0x1p-32 + double(random()) * 0x1p-60;
        return std::ldexp(random() % 2 ? mantissa : -mantissa, int(random() % 13) - 6);
    };
    std::vector<FloatPairQuestion> asked;
    for (size_t i = 0; i < kCases; ++i) {
        const double a = number();
        // Every other sum cancels, all but some bits.
        const double b = i % 2 ? number() : -a * (1 + std::ldexp(number(), -20));
        asked.push_back({pair_of(a), pair_of(b)});
    }
    return asked;
}

bool are_right(std::span<const FloatPairQuestion> asked, std::span<const FloatPairAnswer> told) {
    for (size_t i = 0; i < asked.size(); ++i)
        if (!is_right(asked[i], told[i]))
            return false;
    return true;
}

bool driver_keeps_float_pairs() {
    const std::array stages{ShaderStage{GL_COMPUTE_SHADER, "float_pair_check.comp.glsl"}};
    const Result<gl::Program> program = link_program(stages, {});
    if (!program)
        return false;
    const std::vector<FloatPairQuestion> asked = float_pair_questions();
    std::vector<FloatPairAnswer> told(asked.size());
    const auto from = make_buffer(asked.size() * sizeof(FloatPairQuestion), asked.data());
    const auto to = make_buffer(told.size() * sizeof(FloatPairAnswer), nullptr);
    glUseProgram(program->id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, OVC_BINDING_RAYS, from.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, OVC_BINDING_ANSWERS, to.id());
    glDispatchCompute(GLuint(asked.size() / OVC_CHECKED_PAIRS), 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(to.id(), 0, GLsizeiptr(told.size() * sizeof(FloatPairAnswer)),
                            told.data());
    return check_gl("checking pairs of floats") && are_right(asked, told);
}

} // namespace ovc
