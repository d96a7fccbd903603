# Profiles two components alone and together, and idle, from recordings, and flies a mission with the joint profile.
mkdir rec
record() { printf 'time_s,power_w\n0,%s\n1,%s\n2,%s\n' "$2" "$2" "$2" > "rec/$1.csv"; }
record idle 2
for fps in 5 10; do
    record "detection-$fps-{key_bits}" "$((2 + fps))"
    for bits in 32 448; do
        record "encryption-{fps}-$bits" 3
        record "detection+encryption-$fps-$bits" "$((3 + fps))"
    done
done
cat > spec.toml <<'TOML'
above_idle = true
[sampler]
kind = "recorded"
file = "rec/{component}-{fps}-{key_bits}.csv"
idle_file = "rec/idle.csv"
[components.detection]
qos = { fps = [5, 10] }
[components.encryption]
qos = { key_bits = [32, 448] }
[[together]]
components = ["detection", "encryption"]
TOML
flightwatt profile spec.toml -o out || exit
cat out/detection+encryption.csv
cat > mission.toml <<TOML
name = "joint"
mechanical = "$SOURCE/fits/mechanical/opterra-table1.toml"
battery = "$SOURCE/fits/battery/paper.toml"
[components."detection+encryption"]
profile = "out/detection+encryption.csv"
[components.idle]
profile = "out/idle.csv"
[[schedule]]
otherwise = true
run = { idle = {}, "detection+encryption" = { fps = 7.5, key_bits = 32 } }
TOML
flightwatt simulate mission.toml --json | grep compute
