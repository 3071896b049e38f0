// SPDX-License-Identifier: Apache-2.0
// Writes the sources of kernel_variants() as files that other compilers take.
// usage: kernel_sources FOLDER
#include "gpu/variants/kernel_variants.h"

#include <cstdio>
#include <fstream>
#include <string>

/// Returns the end of a file's name by which glslangValidator knows the stage.
static const char* ending(GLenum stage) {
    return stage == GL_COMPUTE_SHADER ? ".comp" : stage == GL_VERTEX_SHADER ? ".vert" : ".frag";
}

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: kernel_sources FOLDER\n");
        return 2;
    }
    size_t number = 0;
    for (const ovc::ShaderConfig& config : ovc::kernel_variants()) {
        for (const ovc::ShaderStage& stage : ovc::stages_of(config)) {
            std::vector<std::string> files;
            const auto source = ovc::expand_shader(stage.source, config.defines(), files);
            if (!source) {
                std::fprintf(stderr, "%s\n", source.error().message.c_str());
                return 1;
            }
            const std::string path = std::string(arguments[1]) + "/variant" +
                                     std::to_string(number) + ending(stage.stage);
            if (!(std::ofstream(path) << *source).flush()) {
                std::fprintf(stderr, "cannot write %s\n", path.c_str());
                return 1;
            }
        }
        ++number;
    }
    return 0;
}
