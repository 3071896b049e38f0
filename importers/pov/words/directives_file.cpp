// SPDX-License-Identifier: Apache-2.0
// Obeys #fopen, #read, #write and #fclose. A file's name is a variable, which becomes undefined
// once all is read: scenes ask with defined() whether there is more.
#include "importers/file/text.h"
#include "importers/pov/words/data_file.h"
#include "importers/pov/words/files.h"
#include "importers/pov/words/reader.h"

#include <fmt/format.h>

namespace ovc::pov {

/// A scene may write this many bytes in all.
static constexpr size_t kMaxWritten = size_t(64) << 20;

ValueHandle Reader::raw_file(std::string_view after, bool writes) {
    Name* name = raw_name(after);
    Slot* slot = find(name);
    const auto* file = slot ? std::get_if<DataFile>(&slot->value) : nullptr;
    if (!file || file->writes != writes)
        fail(last_, fmt::format("found {} after {}, expected a file opened for {}",
                                ovc::quoted(name->text), after, writes ? "writing" : "reading"));
    return ValueHandle(*slot);
}

DataFile& Reader::open_file(const ValueHandle& handle, const Place& at) const {
    Value* value = value_of(handle);
    auto* file = value ? std::get_if<DataFile>(value) : nullptr;
    if (!file)
        fail(at, "found a value whose reading closes the file");
    return *file;
}

void Reader::do_fopen() {
    Name* name = raw_name("#fopen");
    const Place at = last_;
    const Value value = hooks_.value(*this);
    const auto* text = std::get_if<std::string>(&value);
    if (!text)
        fail(at, fmt::format("found {} after #fopen, expected the name of a file", kind_of(value)));
    DataFile file;
    file.name = *text;
    if (const bool anew = take("write"); anew || take("append")) {
        file.writes = true;
        if (!anew)
            file.text = written_[file.name];
    } else if (!take("read"))
        fail_here("read, write or append");
    else if (const std::string* const text_written = written(file.name))
        file.text = *text_written;
    else if (const std::filesystem::path path = find_file(file.name, ""); path.empty())
        fail(at, fmt::format("there is no file {}", ovc::quoted(file.name)));
    else if (Result<std::string> whole = read_text(path, files_read_); !whole)
        fail(at, whole.error().message);
    else
        file.text = std::move(*whole);
    file.skip_space();
    spend(file.text.size() / 16);
    grow(file.text.size());
    declare(name, /* local= */ false).value = std::move(file);
}

void Reader::do_fclose() {
    Name* name = raw_name("#fclose");
    if (const Slot* slot = find(name))
        if (const auto* file = std::get_if<DataFile>(&slot->value)) {
            if (file->writes)
                written_[file->name] = file->text;
            undefine(name);
        }
}

/// Reads the (FILE, VARIABLE, VARIABLE …) of #read.
void Reader::do_read() {
    raw_expect('(', "#read");
    changed();
    ++reads_;
    Name* name = peek_raw().name;
    const ValueHandle handle = raw_file("#read", /* writes= */ false);
    while (peek_raw().is(',')) {
        raw();
        Name* variable = raw_name("#read");
        const Place at = last_;
        Value* item = nullptr;
        if (Slot* slot = find(variable); slot && peek_raw().is('['))
            if (std::holds_alternative<Array>(slot->value))
                item = value_of(hooks_.item(*this, *slot));
        DataFile& file = open_file(handle, at);
        std::optional<Value> value = file.read();
        if (!value)
            fail(at, fmt::format("found {} in {}, expected a text, a float or a vector",
                                 file.ended() ? "nothing more" : "something else",
                                 ovc::quoted(file.name)));
        (item ? *item : declare(variable, /* local= */ false).value) = std::move(*value);
    }
    raw_expect(')', "#read");
    if (open_file(handle, last_).ended())
        undefine(name);
}

/// Reads the (FILE, VALUE, VALUE …) of #write.
void Reader::do_write() {
    raw_expect('(', "#write");
    const ValueHandle handle = raw_file("#write", /* writes= */ true);
    for (take_comma(); !take(')'); take_comma()) { // commas may be left out
        const Place at = peek().place;
        const Value value = hooks_.value(*this);
        DataFile& file = open_file(handle, at);
        const size_t before = file.text.size();
        if (!file.write(value))
            fail(at, "found a value that cannot be written, expected a text or numbers");
        written_bytes_ += file.text.size() - before;
        if (written_bytes_ > kMaxWritten)
            fail(at, fmt::format("stopped after {} bytes written", kMaxWritten));
    }
}

} // namespace ovc::pov
