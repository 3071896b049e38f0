// SPDX-License-Identifier: Apache-2.0
// ProgressLines tells programs how a rendering goes: a JSON object a line (docs/guide/film.md).
#pragma once

#include "core/result.h"
#include "core/system/stopwatch.h"
#include "host/render/render.h"

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

namespace ovc {

class ProgressLines {
public:
    /// path: of a file, FIFO or device, which is written to as the rendering goes; "-": standard
    /// output; empty: nothing is written. Error: it cannot be opened.
    static Result<ProgressLines> open(const std::string& path);

    /// Tells, at most four times a second, which share of the pixels or of the time is done.
    void progress(uint32_t frame, double share, const RenderReport& report);
    /// Tells of a file that has been written. finished: it is what was asked for, and not the
    /// picture so far.
    void picture(uint32_t frame, const std::string& file, bool finished);
    /// Tells that nothing follows. Error: lines were lost, and not because a reader had enough.
    Result<Done> end(bool complete);

private:
    struct Close {
        void operator()(std::FILE* file) const {
            if (file != stdout)
                std::fclose(file);
        }
    };

    void put(const std::string& line);

    std::string path_;
    std::unique_ptr<std::FILE, Close> file_; // null: nobody listens
    int failure_ = 0;                        // the errno of the first line that was lost
    Stopwatch watch_;
    double next_seconds_ = 0;
};

} // namespace ovc
