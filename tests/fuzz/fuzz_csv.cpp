// The reader of comma separated values. What it takes must be finite numbers under distinct names.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "files/csv.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto table = dinal::files::parse_csv({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
    if (!table) {
        return table.error().sentence.empty() ? (std::abort(), 1) : 0;
    }
    if (!table->values.allFinite() || static_cast<std::size_t>(table->values.cols()) != table->names.size()) {
        std::abort();
    }
    return 0;
}
