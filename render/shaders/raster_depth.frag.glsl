// Depth only: the optic as its own virtual viewpoint sees it.
void main() {}
