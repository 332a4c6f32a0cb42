// Visits the pairs of a range one by one, for shared/group.h. The includer has defined `void visitPair(uint a, uint
// b)`.
void visitRange(uint a, uint b, uint end) {
    for (; b < end; ++b) visitPair(a, b);
}
