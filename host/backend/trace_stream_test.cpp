// SPDX-License-Identifier: Apache-2.0
// Tests of the loop that reads, traces and writes, on temporary files and a pipe.
#include "host/backend/trace_stream.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <memory>
#include <thread>
#include <unistd.h>

namespace ovc {

class TraceStreamTest : public testing::Test {
protected:
    TraceStreamTest() {
        soup_.chunks.push_back(Chunk::owning(dvec3(0), {{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}}));
        backend_ = make_cpu_backend(soup_);
    }

    using File = std::unique_ptr<FILE, int (*)(FILE*)>;
    static File file_of(const std::string& text) {
        File file(std::tmpfile(), std::fclose);
        std::fwrite(text.data(), 1, text.size(), file.get());
        std::rewind(file.get());
        return file;
    }

    /// Returns the output. error_ receives the sentence of the Error, or nothing.
    std::string trace(const std::string& input, const TraceOptions& options = {}) {
        const File in = file_of(input), out = file_of("");
        const Result<Done> done =
            trace_stream(*backend_, fileno(in.get()), fileno(out.get()), options);
        error_ = done ? "" : done.error().message;
        std::string text(size_t(lseek(fileno(out.get()), 0, SEEK_END)), '\0');
        EXPECT_EQ(pread(fileno(out.get()), text.data(), text.size(), 0), ssize_t(text.size()));
        return text;
    }

    Soup soup_;
    std::unique_ptr<Backend> backend_;
    std::string error_;
};

TEST_F(TraceStreamTest, AnswersEachLineInOrder) {
    EXPECT_EQ(trace("0 0 5 0 0 -1\n# away from it\n0 0 5 0 0 1\n\n0 0 5 0 0 -1 0 4"),
              "5 0.25 0.25 0 0\nmiss\nmiss\n");
    EXPECT_EQ(error_, "");
    EXPECT_EQ(trace(""), "");
}

TEST_F(TraceStreamTest, AnswersOcclusion) {
    TraceOptions options;
    options.any = true;
    EXPECT_EQ(trace("0 0 5 0 0 -1\n0 0 5 0 0 1\n", options), "hit\nmiss\n");
}

TEST_F(TraceStreamTest, AnswersWhatCameBeforeABadLineAndNamesIt) {
    EXPECT_EQ(trace("0 0 5 0 0 -1\n\n1 2 3\n0 0 5 0 0 -1\n"), "5 0.25 0.25 0 0\n");
    EXPECT_EQ(error_,
              "standard input, line 3: found 3 numbers, expected ox oy oz dx dy dz [tmin tmax]");
    EXPECT_EQ(trace(std::string(100000, 'x')), "");
    EXPECT_EQ(error_, "standard input, line 1: longer than 4096 characters, expected a ray");
    EXPECT_EQ(trace(std::string(100000, '\0')), "");
    EXPECT_EQ(error_, "standard input, line 1: longer than 4096 characters, expected a ray; rays "
                      "that are no text need --binary");
}

TEST_F(TraceStreamTest, BatchesDoNotShow) {
    std::string input, expected;
    for (int i = 0; i < 5000; ++i) {
        input += i % 3 ? "0 0 5 0 0 -1\n" : "0 0 5 1 0 0\n";
        expected += i % 3 ? "5 0.25 0.25 0 0\n" : "miss\n";
    }
    for (size_t batch : {1u, 7u, 4096u}) {
        TraceOptions options;
        options.batch_rays = batch;
        EXPECT_EQ(trace(input, options), expected) << batch;
    }
}

TEST_F(TraceStreamTest, SpeaksBinary) {
    const Ray rays[2] = {{{0, 0, 5}, 0, {0, 0, -1}}, {{0, 0, 5}, 0, {0, 0, 1}}};
    const std::string input(reinterpret_cast<const char*>(rays), sizeof(rays));
    TraceOptions options;
    options.binary = true;
    const std::string output = trace(input, options);
    ASSERT_EQ(output.size(), 2 * sizeof(Hit));
    Hit hits[2];
    std::memcpy(static_cast<void*>(hits), output.data(), sizeof(hits));
    EXPECT_EQ(hits[0].t, 5);
    EXPECT_EQ(hits[0].id, (TriangleId{0, 0}));
    EXPECT_FALSE(hits[1].is_hit());

    EXPECT_EQ(trace(input + "abc", options).size(), 2 * sizeof(Hit));
    EXPECT_EQ(error_, "standard input, ray 3: found 3 bytes, expected 64");
    options.any = true;
    EXPECT_EQ(trace(input, options), std::string("\1\0", 2));
}

TEST_F(TraceStreamTest, AnswersBeforeTheEndOfAPipe) {
    int rays[2], hits[2];
    ASSERT_EQ(pipe(rays), 0);
    ASSERT_EQ(pipe(hits), 0);
    std::thread tracer([&] { EXPECT_TRUE(trace_stream(*backend_, rays[0], hits[1], {})); });
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(write(rays[1], "0 0 5 0 0 -1\n", 13), 13);
        char answer[64];
        ASSERT_EQ(read(hits[0], answer, sizeof(answer)),
                  16); // this blocks for ever where rays are not answered
    }
    close(rays[1]);
    tracer.join();
    for (const int end : {rays[0], hits[0], hits[1]})
        close(end);
}

} // namespace ovc
