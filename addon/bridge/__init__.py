"""Between Blender and core: the only place for axis flips, bone rolls and channelbags."""
