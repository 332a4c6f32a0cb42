#pragma once

#include <functional>
#include <string>

#include "checkpoint/record_chain.h"
#include "core/result.h"
#include "sim/saved_state.h"
#include "spherule/v1/checkpoint.pb.h"

namespace spherule::checkpoint {

// A saved state of a simulation, with the data that a program needs in addition to go on from it. In files it is a
// record with the head, records with compressed parts of the data (zstd), and a record for its end.
struct SavedWorld {
    v1::StateHead head;  // without the fields that describe `state`
    sim::SavedState state;
};

using WriteBytes = std::function<Result<void>(const std::string& bytes)>;

// Writes the records of a world as they follow `position`, which moves behind them. Frees the arrays of the state as it
// goes. May be called by a thread that does not own the device.
Result<void> write(SavedWorld world, Position& position, const WriteBytes& bytes);

// Reads the world whose head is the next record. Input if it is incomplete or damaged, Refused if there is no memory
// for it.
Result<SavedWorld> readWorld(RecordReader& reader);

// Reads the head alone, which is the next record.
Result<v1::StateHead> readHead(RecordReader& reader);

// Reads the only world of a checkpoint.
Result<SavedWorld> readCheckpoint(const std::string& path);

}  // namespace spherule::checkpoint
