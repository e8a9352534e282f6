"""Work in processes of its own: one that crashes, hangs or eats the memory takes nothing along."""
