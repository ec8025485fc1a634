// The whole Lua-visible side, in safe mode. An input that begins with -- is Lua text, any other is choices for
// write_lua.
#include <cstddef>
#include <cstdint>

#include "fuzz/lua_runner.hpp"
#include "fuzz/lua_writer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    if (text.starts_with("--")) {
        run_stranger(text);
    } else {
        run_stranger(write_lua({data, size}));
    }
    return 0;
}
