flightwatt profile --check-interpolation "$SOURCE/fits/compute/tx2-detection.csv" "$SOURCE/fits/compute/tx2-encryption.csv" | sed "s|$SOURCE/||"
