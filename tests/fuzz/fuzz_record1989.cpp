// The reader of the record of 1989: six columns of finite numbers, or a sentence.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "files/record1989.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto table = dinal::files::parse_record1989({reinterpret_cast<const char*>(data), size}, "fuzz.dat");
    if (!table) {
        return table.error().sentence.empty() ? (std::abort(), 1) : 0;
    }
    if (!table->values.allFinite() || table->values.cols() != 6) {
        std::abort();
    }
    return 0;
}
