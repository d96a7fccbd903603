cp -r "$SOURCE/fits" "$SOURCE/missions" .
for mission in adaptive-replanned phased; do
    printf '\n[uncertainty]\nlevel_sd_percent = { cruise = 3 }\n' >> missions/paper/$mission.toml
done
flightwatt compare missions/paper/adaptive-replanned.toml missions/paper/phased.toml --samples 200 --seed 1
