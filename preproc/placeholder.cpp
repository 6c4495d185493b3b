// Replaced by the folder's first unit.
