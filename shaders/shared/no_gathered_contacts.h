// For kernels that do not run in the model `accurate`: see gathered_contacts.h.
void gather(real4 surface, Obstacle mesh, uint key) {}
void visitGathered(Obstacle mesh) {}
