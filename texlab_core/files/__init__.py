"""Files written whole or not at all, strict JSON, resources, words for errors."""
