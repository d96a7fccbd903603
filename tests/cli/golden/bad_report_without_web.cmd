FLIGHTWATT_WEB=nowhere flightwatt report "$SOURCE/missions/paper/phased.toml" -o result.html; code=$?; ls; exit $code
