#include "codec/order.h"

#include <string>
#include <utility>

namespace spherule::codec {

namespace {

constexpr std::size_t idBytes = 3;

}  // namespace

v1::Order orderMessage(std::uint32_t epoch, std::uint32_t number, std::span<const std::uint32_t> ids) {
    v1::Order order;
    order.set_epoch(epoch);
    order.set_number(number);
    std::string bytes(ids.size() * idBytes, '\0');
    for (std::size_t k = 0; k < ids.size(); ++k)
        for (std::size_t byte = 0; byte < idBytes; ++byte)
            bytes[idBytes * k + byte] = static_cast<char>(ids[k] >> (8 * byte) & 0xffU);
    order.set_ids(std::move(bytes));
    return order;
}

Result<std::vector<std::uint32_t>> idsOf(const v1::Order& order, std::uint32_t spheres) {
    const std::string& bytes = order.ids();
    if (bytes.size() != idBytes * std::size_t{spheres})
        return fail(ErrorKind::Input, "order",
                    "has " + std::to_string(bytes.size()) + " bytes for " + std::to_string(spheres) + " spheres");
    std::vector<std::uint32_t> ids(spheres);
    std::vector<bool> seen(spheres);
    for (std::size_t k = 0; k < ids.size(); ++k) {
        for (std::size_t byte = 0; byte < idBytes; ++byte)
            ids[k] |= std::uint32_t{static_cast<unsigned char>(bytes[idBytes * k + byte])} << (8 * byte);
        if (ids[k] >= spheres || seen[ids[k]])
            return fail(ErrorKind::Input, "order", "is no permutation: place " + std::to_string(k));
        seen[ids[k]] = true;
    }
    return ids;
}

}  // namespace spherule::codec
