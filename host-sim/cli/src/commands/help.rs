//! What `--help` adds to a command: examples, and what its status means. A test runs them.

pub(super) const DROP: &str = "\
Examples:
  touchdown drop                                the rig of the source paper
  touchdown drop backward-whirl --report w.html
  touchdown drop my.toml --json - --stream s.csv
  touchdown drop my.toml --on qemu              the detector as the firmware's image

Exit status: 0 done, whatever the rotor did; 2 bad usage or input.";

pub(super) const REPLAY: &str = "\
Examples:
  touchdown replay s.csv --scene my.toml              a stream, as `drop --stream` writes it
  touchdown replay rec.csv --scene my.toml --columns map.toml
  touchdown replay rec.cfg --scene my.toml            COMTRADE with channels ax, ay, bx, by
  touchdown replay rec.csv --scene my.toml --columns map.toml --resample 20000

The file of --columns; delimiter, decimal commas, comments and the header's line are found:
  [time]
  column = \"t\"                  a name without its unit, or a number from 1
  unit = \"ms\"                   s, ms, us, ns; not needed where the header says it
  [ax]                           also [ay], [bx], [by]: x right, y up
  column = \"X1\"
  unit = \"um\"                   um, mm, m, nm, mil, in, V, mV
  [ay]
  column = 3
  unit = \"V\"
  sensitivity = \"-7.87 V/mm\"    or \"200 mV/mil\"
  offset = -10.0                 with the rotor in the bearing's centre, in that unit
  reversed = true                it counts the other way
  [speed]
  column = \"n\"
  unit = \"rpm\"                  rpm, rad/s, Hz; reversed = true: clockwise
  [levitated]
  column = \"AMB on\"
  above = 2.5                    on where it is above this; reversed = true: off there

Instead of a time column: rate_hz = 20000. Before the tables: axes = \"sensors\" where x and y
are those of sensors mounted at the scene's mounting_deg. docs/use/recordings.md has all of it.

Exit status: 0 done, whatever the rotor did; 2 bad usage or input.";

pub(super) const COMPARE: &str = "\
Both go through the same detector. B is laid over A by the first fall, or else the first
impact, and then by the waveforms about it. Each event is held against the nearest of its
kind; one that only one of them has is a difference. Impacts below 20 mm/s are shown but
not judged.

Examples:
  touchdown compare before.csv after.csv --scene my.toml
  touchdown compare rig.csv model.csv --scene my.toml --columns map.toml --columns-b stream.toml
  touchdown compare a.cfg b.cfg --scene my.toml --within-ms 0.2 --within-percent 5

Exit status: 0 all within the tolerance; 1 not; 2 bad usage or input.";

#[cfg(unix)]
pub(super) const RIG: &str = "\
Examples:
  touchdown rig
  touchdown rig my.toml --keep rig

It prints the socket and takes orders, a line each. The rotor lies at first:

  lift                  lift the rotor, from wherever it is
  drop                  let it go: the scene's drop, then it lies again
  fault CHANNEL KIND    ax, ay, bx or by: open, short, dropped, stuck, reversed, swapped
  repair                all channels
  noise PART            of the link's bytes: 0.01 spoils one in a hundred
  cut                   the controller's power, and give it back at once
  service on|off        its service input: without a key it obeys only while that is on
  quit

In another terminal:
  touchdown live tcp:127.0.0.1:PORT
  touchdown log list rig/log

Exit status: 0 quit; 2 bad usage or input, or the image failed.";

pub(super) const TRADE: &str = "\
Examples:
  touchdown trade
  touchdown trade my.toml --json - --report t.html --svg t.svg

Exit status: 0 done; 2 bad usage or input.";

pub(super) const LIMITS: &str = "\
Examples:
  touchdown limits --json limits.json
  touchdown limits --machines 1600              random machines of the level coupled
  touchdown limits --machine 975                the scene file of one of them";

pub(super) const SCORE: &str = "\
Examples:
  touchdown score --quick                       a look, in seconds
  touchdown score --only fall,impact --seeds 2 --json score.json
  touchdown score --only quiet --hours 24       the long run
  touchdown score --on qemu --quick             the firmware's image";

pub(super) const MERGE: &str = "\
Examples:
  touchdown sweep merge run                     parts that share a folder
  touchdown sweep merge a b --json -            two folders; the results go to a

Exit status: 0 done; 2 a part is missing, or of another plan.";

pub(super) const LOG: &str = "\
Examples:
  touchdown log list flash.bin                  a dump of the log's flash
  touchdown log list /dev/ttyACM0               the controller itself, 5 s an episode
  touchdown log erase /dev/ttyACM0 7 --key-file k

DUMP or port: a dump from the log's first address, a file of one episode, a serial device
(/dev/..., COM3), tcp:HOST:PORT or unix:PATH.";

pub(super) const LOG_LIST: &str = "\
Examples:
  touchdown log list flash.bin
  touchdown log list flash.bin --json -

Exit status: 0 done; 2 no log, or no answer.";

pub(super) const LOG_SHOW: &str = "\
Examples:
  touchdown log show flash.bin                  the newest
  touchdown log show flash.bin 2 --json -

Exit status: 0 done; 2 no log, no such episode, or no answer.";

pub(super) const LOG_EXPORT: &str = "\
Examples:
  touchdown log export flash.bin --out e.csv    the newest, for replay
  touchdown log export flash.bin 2 --format comtrade --out e.cfg
  touchdown log export flash.bin --format json --out -

Exit status: 0 done; 2 no log, no such episode, one without a header, or no answer.";

pub(super) const LOG_VERIFY: &str = "\
Examples:
  touchdown log verify flash.bin
  touchdown log verify flash.bin --json verdict.json

Exit status: 0 no episode is damaged; 1 one is; 2 no log, or no answer.";

pub(super) const LOG_ORDER: &str = "\
Examples:
  touchdown log lock /dev/ttyACM0 7 --key-file k
  touchdown log unlock /dev/ttyACM0 7           with the service input on
  touchdown log erase /dev/ttyACM0 7 --json -

A locked episode is neither overwritten nor erased. These orders need the key of the
controller's configuration, or where that has none its service input on. `erase` needs `run`
off too. A locked episode and the newest one stay. Nothing asks again.

Exit status: 0 done; 1 the controller refuses; 2 bad usage or input, or no answer.";

pub(super) const CLEAR: &str = "\
Examples:
  touchdown clear /dev/ttyACM0 --key-file k
  touchdown clear /dev/ttyACM0 --json -         with the service input on

It clears a trip and the faults, if their causes are gone. It does not start the machine:
`run` comes with a new proof of levitation. It needs the key of the controller's
configuration, or where that has none its service input on; and a rotor that floats or
lies still, and that is seen.

The key file has the 32 hexadecimal digits of `key` in the configuration's `[link]`.

Exit status: 0 done; 1 the controller refuses; 2 bad usage or input, or no answer.";

pub(super) const SCENE: &str = "\
Examples:
  touchdown scene list
  touchdown scene explain my.toml";

pub(super) const EXPLAIN: &str = "\
Examples:
  touchdown scene explain rig
  touchdown scene explain my.toml --json -

Exit status: 0 done; 2 bad usage or input.";

pub(super) const SCENES: &str = "\
Examples:
  touchdown scene list
  touchdown scene list --json -";

pub(super) const LIVE: &str = "\
Examples:
  touchdown live /dev/ttyACM0                 a controller at 115 200 baud
  touchdown live tcp:rig.local:4000           one behind a socket
  touchdown live unix:/tmp/rig.sock           the emulated one
  touchdown live /dev/ttyACM0 --record r.jsonl
                                              the view, and all of it into a file
  touchdown live /dev/ttyACM0 --json | jq 'select(.said == \"event\")'

On a terminal: phase, orbit, outputs, faults, counters, events and episodes. Into a pipe,
or with --json, a line of JSON for each state (20 a second), event, set of positions and
episode, and for each time that the controller comes or goes; docs/use/live.md lists the
fields. A line that breaks is opened again until q, Ctrl-C or --seconds ends it.

Exit status: 0 done; 2 bad usage, or no controller answered in all the time of --seconds.";

pub(super) const CALIBRATE: &str = "\
Examples:
  touchdown calibrate led.csv --scene my.toml
  touchdown calibrate led.csv --scene my.toml --clearance 0.252 --write new.toml
  touchdown calibrate led.csv --config old.toml --scale sensor --report r.html --json -

Lead the rotor slowly round the retainer, pushed outward by the magnets, and record that:
docs/use/calibrate.md. An ellipse shows zero, skew and the ratio of the gains. It does not
tell gain from clearance: --scale says which of them is believed.

Exit status: 0 done; 1 the check is refused; 2 bad usage or input.";

pub(super) const CONFIG: &str = "\
Examples:
  touchdown config /dev/ttyACM0               as TOML, to look at
  touchdown config /dev/ttyACM0 > c.toml      or to edit
  touchdown config /dev/ttyACM0 --set c.toml --key-file k
                                              and to send back
  touchdown config unix:/tmp/rig.sock --json -
                                              the emulated controller's, as JSON

The file has tables, keys and units of a scene, and those of the sensors' converter:
docs/formats/link.md. It is checked before anything is sent. The controller stores it and
restarts: its outputs fall for a moment. It refuses while it watches, and while a drop runs
or is latched. What has changed is printed once it is back.

--set needs the controller's key, or where it has none its service input on. The file sets
another key by `[link] key = \"...\"`, 32 hexadecimal digits, before `[guard]`; without it
the key stays. A key is never shown. `[guard]` comes last, with all its keys: a file that
was cut short is refused.

Exit status: 0 done; 1 the controller refuses; 2 bad usage or input, or no answer.";

pub(super) const COMPLETIONS: &str = "\
Examples:
  touchdown completions bash > ~/.local/share/bash-completion/completions/touchdown
  touchdown completions zsh > ~/.zfunc/_touchdown
  touchdown completions fish > ~/.config/fish/completions/touchdown.fish";
