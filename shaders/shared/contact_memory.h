// The memory of listed contacts: `contactX`, `contactY` and `contactZ`. In the model `balanced`, they are the impulse
// of the last substep on the first sphere (N s). There `torqueX`, `torqueY` and `torqueZ` are the torque of its
// friction, per lever of a sphere (N s). In `accurate`, they are the tangential displacement of the first sphere (m).
//
// A pair has PAIR_REMEMBERS if its contact remembers something but zero. The memory of other pairs has any content.
//
// Each array has two halves of params.pairCapacity elements. The lists of all spheres use the halves in turn, so that a
// rebuild can copy from the old half to the new one. The includer binds `counters`.

// The first element of the present lists' half.
uint presentHalf() {
    return (counters[COUNTER_LISTS] & 1u) * params.pairCapacity;
}

uint previousHalf() {
    return params.pairCapacity - presentHalf();
}
