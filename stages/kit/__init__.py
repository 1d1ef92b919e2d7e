"""What several stages share: settings, rows, cache, statistics, parallel map."""
