// The reader of comma separated values: a table that it accepts has finite numbers only.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "files/csv.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto read = dinal::files::parse_columns({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
    if (!read) {
        return read.error().sentence.empty() ? (std::abort(), 1) : 0;
    }
    const auto table = dinal::files::table_of(*read);
    if (!table) {
        return table.error().sentence.empty() ? (std::abort(), 1) : 0;
    }
    if (!table->values.allFinite() || static_cast<std::size_t>(table->values.cols()) != table->names.size()) {
        std::abort();
    }
    return 0;
}
