#include "codec/columns.h"

#include <utility>

#include "codec/rendition.h"

namespace spherule::codec {

const PerColumn<Column> columns = {{
    {.name = "position",
     .quantumFor = quantumOf,
     .read =
         [](const v1::Frame& frame) {
             return EncodedColumn{frame.quantum(), frame.spb()};
         },
     .write =
         [](v1::Frame& frame, double quantum, std::string spb) {
             frame.set_quantum(quantum);
             frame.set_spb(std::move(spb));
         }},
}};

}  // namespace spherule::codec
