// Functions compiled for several vector units.
#pragma once

/// Marks a function to be compiled for wider vector units too, the best of which is chosen when the program
/// is loaded. The results are the same on all: no operation is contracted or reordered. (Sanitizers cannot
/// run the code that chooses.)
#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define CATOPTRA_VECTOR_CLONES [[gnu::target_clones("default", "avx2", "avx512f")]]
#else
#define CATOPTRA_VECTOR_CLONES
#endif
