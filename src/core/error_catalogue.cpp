// The long explanations behind `whirl explain CODE`. Codes never change their meaning. E01-E39: the
// deck; E60-E89: while running; E90-E99: files and plug-ins; W..: warnings. A new code is one more
// row, kept in order.
#include <core/error.hpp>

namespace whirl {

const std::vector<CodeInfo>& error_catalogue() {
  static const std::vector<CodeInfo> t = {
      {"E01", "the deck is not valid TOML",
       "A deck is a TOML 1.0 file: 'key = value' lines under [table] and [[list of tables]] "
       "headers. Text stands in double quotes, lists in "
       "square brackets, comments start with '#'. The place shown is where reading had to stop; "
       "the mistake may be just before it, "
       "for example a quote or bracket that was not closed on the line above. Reading goes on "
       "after the line, so that one run shows all "
       "mistakes.",
       "title = \"Pump      # wrong: the quote is not closed\ntitle = \"Pump\"     # right"},
      {"E02", "a file cannot be read",
       "The deck, a file it includes or a table it names is missing, is a folder, or may not be "
       "read. A relative path is taken from the "
       "folder of the file that names it.",
       "file = \"tables/bearing.csv\"   # beside the deck, in the folder tables"},
      {"E03", "the file is not a deck",
       "The file is empty, is not UTF-8 text, is larger than the limit (8 MiB for a deck, 256 MiB "
       "for a CSV table), or nests brackets or "
       "dotted keys deeper than any deck does (64 levels). It was rejected before it was parsed.",
       ""},
      {"E04", "unknown key",
       "The table has no such key; keys are never ignored silently. The hint names the nearest key "
       "that exists here. Keys that belong to "
       "another 'type' are unknown too. `whirl schema --reference` lists every table and key. In "
       "CSV tables and 'columns' the same holds for "
       "column names.",
       "lenght = \"80 mm\"   # wrong\nlength = \"80 mm\"   # right"},
      {"E05", "a key is missing",
       "The table lacks a key that has no default. The place shown is the header of the table, or "
       "the 'columns' list for a table of rows.",
       "[[disk]]\nname = \"impeller\"   # wrong: 'at' is missing"},
      {"E06", "wrong type of value",
       "The key expects another kind of value: text, a plain number, a whole number, true or "
       "false, a list, or a table. Dates and times are "
       "never expected.",
       "modes = \"ten\"   # wrong\nmodes = 10      # right"},
      {"E07", "a unit is missing",
       "Every value that has a dimension carries its unit in a string; tables carry it in the "
       "column header. There is no default unit, since "
       "unstated units are the most frequent cause of wrong results.",
       "clearance = 75         # wrong\nclearance = \"75 um\"    # right\ncolumns = "
       "[\"length[mm]\", \"od[mm]\"]"},
      {"E08", "wrong dimension",
       "The value has a unit, but of another kind of quantity. Angles are tracked: 1/s is not an "
       "angular speed (is it Hz or rad/s?), a plain "
       "number is not an angle. Hz counts as 2 pi rad/s where an angular speed is wanted. An ounce "
       "('oz') is a mass, 'ozf' a force; "
       "so 'oz.in' is an unbalance and 'ozf.in' a torque.",
       "speed = \"157 1/s\"     # wrong\nspeed = \"157 rad/s\"   # right, or \"25 Hz\", or \"1500 "
       "rpm\""},
      {"E09", "unknown unit",
       "The unit is not in the table of units. Units are case-sensitive (kN, not KN; rpm, not RPM) "
       "and joined by a point: N.m, not Nm. "
       "'lb' alone is ambiguous: 'lbm' is the mass, 'lbf' the force. `whirl schema --units` lists "
       "all units.",
       "torque = \"5 Nm\"    # wrong\ntorque = \"5 N.m\"   # right"},
      {"E10", "a quantity cannot be read",
       "A quantity is a number and a unit; sums, products, quotients and powers of such are "
       "allowed, with parentheses. After a '/' a further "
       "product needs parentheses, because \"W/m.K\" is read in two ways.",
       "k = \"8e4 N/m\"\nlength = \"2 * 35 mm + 1 in\"\nconductivity = \"15 W/(m.K)\""},
      {"E11", "a quantity without quotes",
       "In TOML a value with a unit is a string and stands in double quotes.",
       "length = 80 mm       # wrong\nlength = \"80 mm\"     # right"},
      {"E12", "a comma inside a number",
       "Decimals take a point, and thousands are not separated. In lists the comma separates "
       "values, so 1,5 would be two of them.",
       "viscosity = \"0,019 Pa.s\"   # wrong\nviscosity = \"0.019 Pa.s\"   # right"},
      {"E13", "not a finite number",
       "nan and inf are legal TOML but never a meaningful input here; a number beyond the range of "
       "double precision is rejected as well. To "
       "say that something has no limit, leave the key out.",
       "dt_max = inf   # wrong: leave the key out"},
      {"E14", "out of range",
       "The value lies outside what is physically or numerically possible for this key: a negative "
       "or zero size, a loss factor above one, a "
       "number of points below the least. The message states the range.",
       "od = \"-80 mm\"   # wrong"},
      {"E15", "unknown option",
       "The key takes one of a few words; the hint lists them and names the nearest one.",
       "type = \"liner\"    # wrong\ntype = \"linear\"   # right"},
      {"E16", "duplicate name",
       "Two things of the same kind have the same name, so a reference to it would be ambiguous. "
       "Sections of different shafts may share a "
       "name; it is then written shaft/section where it is used. Results of steps, probes and "
       "shafts stand "
       "in files called after them, in which all but letters, digits, '-' and '_' becomes '_': "
       "names that "
       "become one there, or a transient 'x_modes' beside a modal step 'x', would write one file.",
       "[[disk]]\nname = \"impeller\"\n[[disk]]\nname = \"impeller\"   # wrong"},
      {"E17", "unknown name",
       "A material, shaft or step is named that the deck does not define. Built-in materials are "
       "steel, stainless_steel, titanium, aluminium, "
       "inconel_718 and cast_iron; others come from [[material]].",
       "material = \"stel\"   # wrong"},
      {"E18", "unknown station",
       "A place on a shaft is written \"section\", \"section:start\", \":mid\" or \":end\", each "
       "with an offset where wanted "
       "(\"body2:end-20 mm\"), or as a distance from the left end (\"1.14 m\"). A section alone "
       "means its start. The name of a disk or bearing is a "
       "place too, and so is the shaft (\"hp:end\"). With several shafts write \"hp/body2:mid\". A "
       "name of a section, a shaft, a disk or "
       "a bearing that would mean two places must not stand alone.",
       "at = \"body2:middle\"   # wrong\nat = \"body2:mid\"      # right"},
      {"E19", "beyond the shaft",
       "The place lies before the start or after the end of its shaft. The message states the "
       "distance and the length of the shaft.",
       "at = \"overhang:end + 20 mm\"   # wrong: the shaft ends at overhang:end"},
      {"E20", "wrong number of values",
       "A row has fewer or more cells than the header, or two lists that belong together (time and "
       "value, say) differ in length.",
       "columns = [\"name\", \"length[mm]\", \"od[mm]\"]\nrows = [[\"body\", 260]]   # wrong: od "
       "is missing"},
      {"E21", "values do not increase",
       "The times of a law and the speeds of a table must increase from each row to the next; a "
       "jump is written with two close points or with "
       "a 'piecewise' law.",
       "time = [\"0 s\", \"2 s\", \"1 s\"]   # wrong"},
      {"E22", "a table does not cover the speed range",
       "A step asks for speeds outside the table of a bearing whose 'extrapolate' is \"error\". "
       "Extend the table, narrow the step, or write "
       "extrapolate = \"hold\" to keep the end values.",
       ""},
      {"E23", "bore not smaller than the outer diameter",
       "A section or disk has an inner diameter equal to or larger than its outer diameter at one "
       "of its ends: no material is left.",
       "od = \"80 mm\"\nid = \"80 mm\"   # wrong; a diameter, not a radius"},
      {"E24", "no such body",
       "No distribution of mass has these moments of inertia: Id is at least Ip/2 (equality for an "
       "infinitely thin disk), and for a full tensor "
       "the sum of any two principal moments is at least the third. Often Ip and Id are "
       "interchanged or one is given in other units.",
       "Ip = \"0.92 kg.m^2\"\nId = \"0.40 kg.m^2\"   # wrong: less than half of Ip"},
      {"E25", "sections overlap or leave a gap",
       "Sections follow each other from left to right. Where 'from' states the start of a section "
       "it must be the end of the one before.",
       ""},
      {"E26", "keys that contradict or need each other",
       "The same thing is given in two ways, or only in part: a disk by mass and by geometry, a "
       "shaft by rows and by a file, od with od_l. Keep "
       "one way, complete.",
       "mass = \"38 kg\"\nod = \"260 mm\"   # wrong: either mass, Ip, Id or od, width, material"},
      {"E27", "undefined or circular parameter",
       "${name} refers to a key of [parameters]. A parameter may use others, but not itself by any "
       "detour.",
       "[parameters]\na = \"${b}\"\nb = \"${a}\"   # wrong"},
      {"E28", "a file includes itself",
       "'include' lists files whose tables are merged before those of the deck. A file may not "
       "include itself by any detour, and nesting is "
       "limited to 16 levels.",
       ""},
      {"E29", "set twice",
       "A key is set both in an included file and in the file that includes it, or twice in one "
       "table. Lists of tables ([[disk]]) are joined "
       "instead. To try another value without editing, use --set or a parameter.",
       ""},
      {"E30", "undefined or circular step reference",
       "'from' names an earlier step whose result this step starts from. It must exist, stand "
       "above, and be of a kind that leaves a state: "
       "static or transient.",
       "[[step]]\nname = \"a\"\nfrom = \"a\"   # wrong"},
      {"E31", "unknown format version",
       "The first lines of a deck say 'format = 1'. A deck of a later version needs a later "
       "program.",
       "format = 1"},
      {"E32", "unrestrained motion",
       "A static equilibrium is asked for, but nothing resists one of the rigid motions of a "
       "shaft, so there is none or it is not unique. The "
       "message names the shaft and the motion. The spin itself need not be held. Add a stiffness "
       "in that direction, hold it with a bearing of "
       "type \"rigid\", or start the transient from rest (start = \"rest\").",
       "[[bearing]]\nname = \"thrust\"\nat = \"shaft:start\"\ntype = \"rigid\"\ndirections = "
       "[\"x\"]"},
      {"E33", "the output would fill the disk",
       "The estimate of what the deck asks for exceeds the free space of the results folder, or "
       "the "
       "limit that --max-disk sets. Write "
       "rows less often (output.every), ask for "
       "fewer frames, a window, or fewer contents in [[output.vtk]], or choose another directory.",
       ""},
      {"E34", "a --set that cannot be applied",
       "The form is --set path=value, with the path of keys as in the deck. Members of a list are "
       "found by name or by number from 0. The value is "
       "checked exactly like one in the deck; quotes may be left out.",
       "--set parameters.clearance=90um\n--set bearing.DE.kyy='8e7 N/m'\n--set "
       "step.run_up.duration='5 s'"},
      {"E35", "nothing to work on",
       "The model has no shaft, a shaft has no section, or a run is asked for and the deck has no "
       "step.",
       "[[step]]\nname = \"modes\"\ntype = \"modal\"\nspeed = \"3000 rpm\""},
      {"E36", "non-physical material",
       "E, G and the density are positive, and Poisson's ratio lies between -1 and 0.5. G, when "
       "given, must agree with E/(2(1+nu)) for an "
       "isotropic material unless nu is left out.",
       ""},
      {"E37", "speeds that contradict each other",
       "The speeds of two geared shafts are to each other as -teeth/other_teeth (external gears "
       "turn against each other; other_teeth < 0, an "
       "internal gear, turns the same way). speed_ratio, initial_spin and prescribed speeds of the "
       "shafts must agree with it: the message names the "
       "ratio that fits. Shafts joined by a coupling turn at one speed, and both turn. Two drives "
       "of one line of shafts prescribe one speed, else they wind up what is between them; a shaft "
       "with rotating = false has none.",
       "[[shaft]]\nname = \"pinion\"\nspeed_ratio = -2.5\n\n[[bearing]]\ntype = \"gear\"\nat = "
       "\"wheel\"\nto = \"pinion:mid\"\nteeth = 50\nother_teeth = 20"},
      {"E38", "an unbalance that its shaft cannot have",
       "An unbalance is mass times eccentricity of the bodies it turns with. It is shared among "
       "neighbouring nodes until each carries no more than a "
       "tenth of sqrt(mass x inertia); here even the whole line is too light, so that the kinetic "
       "energy would not be positive and every run would grow "
       "without bound. Usually a unit slipped, or the disk that has the unbalance is missing or "
       "has no inertia.",
       "amount = \"100 kg.mm\"   # wrong on a 1 kg rotor\namount = \"100 g.mm\"    # right: 1 g at "
       "100 mm"},
      {"E39", "a linear transient that is not linear",
       "linear = true computes small motions about a rotor that turns at constant speed: a torque "
       "drive, or a prescribed speed that changes, "
       "contradict it, and so does the integrator momentum_rk. Unequal stiffness or inertia of a "
       "shaft that turns makes its matrices turn too; "
       "the message then says so. Leave linear out: the general model does all of these.",
       "[[step]]\nname = \"release\"\ntype = \"transient\"\nlinear = true\ninitial_speed = \"3000 "
       "rpm\""},
      {"E40", "joints that contradict each other or a support",
       "A joint holds two places together exactly. Where two joints meet at the same two lines and "
       "place, or a joint and a rigid support hold the same direction of a node, part of what they "
       "hold is held twice, or no motion is left. The message counts directions held, motions, and "
       "how many of the directions are different (the rank of the constraints). Linkages may close "
       "as many loops as they like: through their lines, which deform.",
       "[[joint]]\nname = \"elbow\"\nkind = \"hinge\"\nat = \"arm/end\"\nto = "
       "\"forearm/start\"\naxis = [0, 0, 1]"},
      {"E41", "an analysis that does not go with a joint",
       "Joints act in every analysis. Refused by name is what supposes something a joint breaks: "
       "rotors that turn steadily with a joint between lines that do not turn as one, or one that "
       "bends between them (a hinge across the axis, a universal joint: its axes turn, and small "
       "motions about it have coefficients that change with the angle; slides and hinges along the "
       "axis of rotation are taken); one kind of "
       "motion alone (lateral, torsional, axial) where a joint stands on a line at an angle to the "
       "x axis, for bending of one line is twist of another there.",
       "type = \"transient\""},
      {"E42", "a file that cannot be converted",
       "whirl convert reads rotors saved by ROSS (.toml, .json) and tables (.csv) of stations or "
       "of "
       "bearing coefficients. A shaft must come out of it: elements that follow each other with "
       "their materials, or stations with lengths and outer diameters. Titles of columns carry "
       "their unit.",
       "Station, Length [mm], OD [mm], ID [mm], Mass [kg], Ip [kg.m^2], It [kg.m^2]"},
      {"E43", "no frames to look at",
       "whirl view arranges the frames of a results folder in ParaView: those of the step or shape "
       "that is named, or of which there are most. A deck writes frames with [[output.vtk]].",
       "[[output.vtk]]\nframes = 100\ncontent = [\"line\", \"surface\", \"bearings\"]"},
      {"E44", "the run would take too much memory",
       "The estimate, made before the deck is meshed, exceeds what the machine, the control group "
       "or "
       "ulimit -v leaves, or the limit that --max-memory sets. It is right within a factor of 2. "
       "Most of it are matrices, a few tens of kB a node, so that fewer elements help; for many "
       "modes "
       "at many speeds ask for fewer. A sweep takes what its processes take together, and about 2 "
       "kB "
       "a run for its table.",
       "whirl run deck.toml --max-memory 64GB\nwhirl run deck.toml --max-memory none"},
      {"E47", "a film that conserves mass where it cannot",
       "cavitation = \"mass_conserving\" follows the oil that a ruptured film carries on to the "
       "next one, in equilibria, small motions and transients. The housing and its grooves must "
       "stand still: in a bearing between two shafts that turn they do not.",
       "[[bearing]]\ntype = \"journal\"\ncavitation = \"reynolds\""},
      {"E61", "an unknown with neither stiffness nor mass",
       "The eigenvalue problem cannot be factored at any shift: nothing in the model resists or "
       "carries the motion that the message names. Hold it, or give "
       "the node mass or stiffness in this direction.",
       ""},
      {"E62", "modes that do not agree with their count",
       "The number of modes found differs from the number that the inertia of K - s M promises. "
       "The matrices are not those of a vibrating structure: M is "
       "indefinite, or K or M is not symmetric.",
       ""},
      {"E63", "balancing that lacks its vectors",
       "Every run has a vector of every sensor and speed of the initial run; probes, planes and "
       "modes that are named exist.",
       "columns = [\"run\", \"probe\", \"angle[deg]\", \"speed[rpm]\", \"amplitude[um]\", "
       "\"phase[deg]\"]"},
      {"E69", "a load path that did not reach its load",
       "The path of equilibria was followed from no load, but not to the load factor or "
       "displacement it should end at: it ran out of points "
       "(max_points), perhaps because it turned back at a limit point; Newton's method did not "
       "converge even in the shortest steps; a section was "
       "tilted by pi from its axis; or the bifurcation at which it should branch does not exist. "
       "The message says which and where. What was found "
       "is written.",
       "path = { load = 5, steps = 40, max_points = 2000 }"},
      {"E70", "an API report that cannot be made",
       "The step looks at journals, seals, clearances and stages of one rotor: those it names must "
       "exist and stand on one shaft, journals must carry it laterally, and the sets of bearings "
       "must be decks by themselves.",
       "[[step]]\ntype = \"api_lateral\"\noperating_speed = [\"7000 rpm\", \"9450 rpm\"]\nbearings "
       "= "
       "[\"DE\", \"NDE\"]\nset = [{ name = \"minimum\", change = [\"bearing.DE.clearance = 60 "
       "um\"] "
       "}]"},
      {"E71", "the split of the rotation reached its limit",
       "A section normal turned by pi from the axis of its shaft: the axial angle and the azimuth "
       "of the transverse rotation then describe the same "
       "motion. With model.chart_change = true (the default) a node goes on in other axes before "
       "that happens; without, and where a tilt is held, the run ends here.",
       ""},
      {"E72", "a time law cannot be built",
       "The points of a law must increase in time, be finite and number at least one; a transition "
       "needs a positive duration.",
       ""},
      {"E73", "a rigid body that cannot be",
       "Mass and moments of inertia must be finite and positive definite where a body is free to "
       "move.",
       ""},
      {"E74", "the momentum form does not cover the model",
       "Integrator momentum_rk writes the equations in momenta of free rigid bodies, bodies about "
       "a fixed point and point masses. The message names "
       "what stands against it: shaft elements with mass, added mass in a bearing, a body without "
       "mass or rotary inertia, a partly held node, "
       "a prescribed motion, or an unbalance that changes in time.",
       "method = \"radau5\""},
      {"E75", "nothing resists a motion",
       "The stiffness of the model is singular: the message names the node and the direction in "
       "which it can move without any force. Add a "
       "support in that direction or hold it rigidly. At a high load the same message means that "
       "the structure is at a limit point or buckles there.",
       "[[bearing]]\nname = \"thrust\"\nat = \"shaft:start\"\ntype = \"rigid\"\ndirections = "
       "[\"x\"]"},
      {"E76", "no equilibrium found",
       "Newton's method found no equilibrium of the spinning, loaded rotor, not even with the "
       "loads put on in steps. The message tells at which part of "
       "the load it stopped. The load may lie beyond a limit point (a buckling step tells), or a "
       "bearing beyond its capacity or outside its table.",
       ""},
      {"E77", "critical speeds cannot be sought or followed",
       "The range of speeds or the order makes no sense, or a critical speed that was counted "
       "could not be followed to its place: two modes "
       "meet there more closely than rounding can tell apart. Narrow the range, or take a Campbell "
       "diagram of it.",
       ""},
      {"E78", "a shaft that shall turn cannot",
       "The spin of the shaft is held by a rigid support, yet the step asks for a speed.",
       "directions = [\"x\", \"y\", \"z\"]    # rx left free"},
      {"E79", "no load that could buckle anything",
       "Gravity and the loads of the deck do not change the stiffness of the model to first order, "
       "so no factor on them makes it singular. Heat, preloads and places that are forced are not "
       "scaled: what they change is in the stiffness already, and a modal or static step tells how "
       "much of it is left.",
       ""},
      {"E80", "a critical-speed map without bearings",
       "The step varies the stiffness of bearings; those it names must exist, and by default "
       "bearings that are not rigid are varied.",
       ""},
      {"E81", "a coefficient table cannot be used",
       "A table needs rows, finite values and speeds that increase.", ""},
      {"E82", "a force curve cannot be used",
       "Polynomials have 1 to 8 coefficients, tables at least two points with increasing "
       "deflections; gaps and stiffnesses are not negative.",
       ""},
      {"E83", "a rolling bearing that cannot be",
       "Balls or rollers must fit side by side on their pitch circle, groove radii exceed half the "
       "ball diameter, and a clearance stays within the "
       "grooves. An axial preload needs a contact angle.",
       ""},
      {"E84", "a journal bearing that cannot be",
       "Clearance positive, preload at least 0 and below 1, pads that do not overlap and leave "
       "something between the grooves, 8 to 360 grid points.",
       ""},
      {"E85", "a viscosity that cannot be found",
       "ISO VG grades hold between 243 and 473 K (-30 to 200 degC), the two-point formula between "
       "223 and 523 K.",
       ""},
      {"E86", "a gear pair that cannot be",
       "Teeth, radius and pressure angle must make a gear pair; stiffness and backlash are not "
       "negative, and the harmonics of the stiffness add up to "
       "less than 1.",
       ""},
      {"E87", "a journal finds no equilibrium in its bearing",
       "The load is more than the film carries at this speed below the eccentricity it is believed "
       "to. The message gives load, capacity and the "
       "eccentricity reached.",
       ""},
      {"E88", "no axes in which an asymmetric rotor is simple",
       "Motions of a shaft with unequal principal stiffnesses are looked at in axes that turn with "
       "it. With shafts of different speeds there are none "
       "in which the matrices are constant or periodic. A cracked shaft breathes at "
       "several multiples of its speed: it has no influence coefficients, and hysteretic damping, "
       "which is known at "
       "one frequency at a time, has no form there.",
       "method: a transient step with a small initial disturbance"},
      {"E89", "no map over this parameter",
       "A stability map reads the deck again for each value of one of its [parameters]; it is "
       "drawn for rotors whose matrices are constant in fixed axes.",
       "[parameters]\nclearance = \"75 um\"\n\n[[step]]\ntype = \"stability\"\nmap = { parameter = "
       "\"clearance\", values = [\"60 um\", \"75 um\", \"90 um\"] }"},
      {"E90", "a plug-in is missing or does not fit",
       "VTK, HDF5 and SUNDIALS live in plug-ins that are loaded only when a deck asks for them. "
       "They stand in lib/whirl of the "
       "installation and come from the same build as the program, which is checked before anything "
       "of them runs. Install the package that holds the one "
       "that is missing, or ask for another output or method.",
       ""},
      {"E91", "a file cannot be written or read",
       "The operating system refused: the disk is full, the folder may not be written, or the file "
       "is not what it should be. Files are written "
       "beside their place and renamed, so that what was there before is unharmed.",
       ""},
      {"E92", "not a JSON file",
       "A file that should be JSON cannot be parsed, holds a number beyond 1e308 or is nested more "
       "than 256 deep; it was probably edited or cut off by another program.",
       ""},
      {"E93", "unknown content of a VTK output",
       "content lists any of line, surface, bearings, orbits.",
       "content = [\"line\", \"surface\"]"},
      {"E94", "the model is not the one of the checkpoint",
       "A resumed run continues the motion bit for bit, so everything the motion depends on must "
       "be what it was: model, laws, integrator, earlier steps. "
       "Outputs, probes, titles, the duration, stop conditions and later steps may change. The "
       "message shows the first line of the resolved deck that differs.",
       "whirl run deck.toml            # anew\nwhirl run deck.toml --resume   # with duration = "
       "\"30 s\" instead of \"20 s\": goes on"},
      {"E95", "nothing to study",
       "whirl study compares integrators on the first transient step of a deck that starts by "
       "itself, and meshes on the steps that are no transients; "
       "whirl study --stability needs a step that names a speed and a rotor with a mode that "
       "oscillates.",
       ""},
      {"E96", "not an exact solution of this deck",
       "whirl study --exact FILE wants the displacements of probes at instants of the first "
       "transient step, in the columns that whirl run writes.",
       "t [s],disk.y [m],disk.z [m]\n0.5,1.2e-05,-3.4e-06"},
      {"E97", "the results folder is in use",
       "Another run writes into this folder. Two runs in one folder would leave a mixture of both. "
       "Wait for it, stop it, or give this one a folder of "
       "its own with -o. A run that was killed does not count: its lock goes with its process.",
       "whirl run deck.toml -o results/second"},
      {"E98", "an environment variable with an unknown value",
       "WHIRL_ISA asks for the kernels of a smaller instruction set: baseline, avx2 or avx512 (the "
       "best there is, also without the variable). A misspelt "
       "word would give other digits than those asked for.",
       "WHIRL_ISA=baseline whirl run deck.toml"},
      {"E99", "a sweep that cannot be made",
       "whirl sweep runs a deck with the values of --vary put in and reads the numbers of "
       "--response "
       "from the tables of each run. Keys are those of --set; tables and columns are listed by "
       "--list. The folder of a sweep remembers what was asked for: --resume and --shard go on "
       "with "
       "the same sweep alone.",
       "whirl sweep deck.toml --vary bearing.NDE.clearance=60um:90um:7 --vary "
       "'parameters.k=normal(1e7 N/m, 5 %)' --samples 200 --response "
       "'first=critical_damped:speed:1'"},
      {"N10", "unknown integrator",
       "The names of the schemes are those of [step.integrator] method.", "method = \"radau5\""},
      {"N11", "an integrator that cannot do what is asked",
       "IDA chooses its steps itself; a fixed step dt needs another scheme.",
       "method = \"radau5\""},
      {"N20", "no acceleration satisfies the equations",
       "A part without mass that nothing holds, or a state outside the model's range: the forces "
       "there cannot be balanced by any acceleration.",
       ""},
      {"N21", "a jump that mass-less parts would have to follow",
       "A prescribed velocity jumps, and unknowns without mass would have to jump with it. Give "
       "the law a short transition, or the parts mass.",
       ""},
      {"N30", "SUNDIALS cannot be set up",
       "The library refused to create its solver, usually for lack of memory.", ""},
      {"N31", "IDA failed",
       "SUNDIALS' integrator IDA returned the code shown; its manual lists them.", ""},
      {"N32", "ARKODE failed",
       "SUNDIALS' integrator ARKODE returned the code shown; its manual lists them.", ""},
      {"R10", "a transient step stopped before its end",
       "The integrator could not go on: Newton's method found no next state however short the "
       "step, a chart or a table reached its limit, or a quantity "
       "became singular. The message says when, where and why; results up to that time are "
       "complete.",
       ""},
      {"R11", "a state that cannot be evaluated",
       "The state found lies outside the range of an element: a tilt beyond the chart, a journal "
       "beyond its clearance, a table beyond its rows.",
       ""},
      {"R20", "the reference run of a study failed",
       "whirl study measures errors against a run of much finer tolerance, which did not reach its "
       "end. The message says why.",
       ""},
      {"W01", "unused parameter",
       "A key of [parameters] is used nowhere: probably a misspelt ${name}, or a leftover.", ""},
      {"W02", "a setting without effect",
       "The key is understood but nothing in this deck reads it, for example a VTK output when no "
       "step is transient, or the 'start' of a step that goes on from another one.",
       ""},
      {"W03", "outside the range of a theory",
       "The model is computed as asked, but the formulas behind it are known to be inaccurate for "
       "these dimensions, or in this state: a film pressed beyond an eccentricity of 0.99, a "
       "shaft that would stand in the poles of a magnet, a "
       "bearing of the short theory that is longer than half its diameter or has more force beyond "
       "that of a finite one than at L/D = 0.5 and an eccentricity of 0.7. The message says what "
       "fits better.",
       ""},
      {"W04", "a contact is closed at rest",
       "A rub, stop or catcher bearing touches already in the state a step starts from, because "
       "the weight or an initial displacement uses up its "
       "gap. That may be meant (a shaft resting in its catcher bearing); else the gap is too small "
       "or the support too soft.",
       ""},
      {"W05", "the two sides of a connection are apart",
       "A bearing or coupling between two shafts acts at one point: its force on one shaft is the "
       "opposite of that on the other. Where the two places do not "
       "coincide, the couple of the two forces is missing from the balance. Gears are apart across "
       "the shafts, never along them.",
       "origin = [\"400 mm\", \"0 mm\", \"0 mm\"]   # the second shaft begins where the first one "
       "ends"},
      {"W06", "a drive clamps the shaft in small motions",
       "A drive that prescribes speed or angle holds the axial angle at its place exactly. In "
       "modes, responses and stability that end does not twist, as if "
       "clamped to an infinite inertia, and the shaft's free spin is no motion. The speed of such "
       "a step is its own, whatever the drive prescribes.",
       "step = \"run up\"   # of the drive: it acts in that transient alone"},
      {"W07", "a list of modes that is not complete",
       "The roots of the eigenvalue problem were counted by the argument principle "
       "(docs/numerics.md), and the list does not hold all of them, or the count did "
       "not settle. The message says how many are missing and about where. The run goes on and "
       "ends with exit code 4: neither the list nor a verdict "
       "of stability drawn from it is to be relied on.",
       ""},
      {"W08", "an unstable equilibrium",
       "The state found is in balance, but its static tangent has directions in which a small "
       "displacement grows: a column beyond its buckling load, a "
       "shaft on a support of negative stiffness, a path beyond a limit point. The number of "
       "directions is that of the negative eigenvalues (inertia of the "
       "factorisation) of a symmetric tangent; of an unsymmetric one (films, cross-coupling) it is "
       "that of the negative real eigenvalues, odd for certain where "
       "the determinant is negative. STEP_unstable_direction.csv holds the lowest one. Gyroscopic "
       "moments, which may hold an even number of directions in a rotor "
       "that spins, are not counted: a modal or stability step judges those.",
       ""},
      {"W09", "a buckling load that the path does not confirm",
       "Linearised buckling supposes that the structure hardly deforms before it buckles. The "
       "equilibria under growing loads were followed to 1.25 times the first "
       "factor; their tangent loses definiteness at another load (more than 2 % away), or not at "
       "all, because the load bends the structure on the way (a shallow "
       "arch, a column that is not straight, a force across the plane). The path is right. Or the "
       "model is unstable before any load acts: temperature, preload or forced places of supports "
       "have buckled it already.",
       "[[step]]\nname = \"path\"\ntype = \"static\"\npath = { load = 2 }"},
      {"W10", "a mesh too coarse for its results",
       "The elements the deck asks for leave frequencies of the step, or the deflections of a "
       "static one, an error above [model.mesh] accuracy. The error is estimated mode by mode: "
       "what the mode would do on elements a fourth as long, to first order; of deflections it is "
       "their change on elements half as long. Without min_elements and max_element_length "
       "the program chooses elements that are short enough.",
       "[model.mesh]\naccuracy = 1e-3"},
      {"W11", "a linear response larger than a gap",
       "Steady responses are computed about the equilibrium, with the stiffness and damping the "
       "supports have there; so are motions in time with linear = true. Where the motion found is "
       "larger than the clearance of a bearing or "
       "the gap of a stop, the machine does something else: it touches, or its film stiffens. In a "
       "film coefficients of small motions mislead from about a third of what is left of the "
       "clearance on. So it does where a play closes or opens, a spring stiffens or a magnet "
       "saturates, such that a force or a moment leaves its linear part by more than 30 %, and "
       "where the amplifier of a magnetic bearing does not give the current, or its rate, that the "
       "motion needs. The message says where, at which speed or time, and by how much.",
       "[[step]]\ntype = \"transient\""},
      {"W12", "a table of a bearing is held beyond its end",
       "The step turns a shaft faster or slower than the table of its bearing covers, and the "
       "bearing says that the coefficients at the edge hold there. They are a guess. A transient "
       "says from when on; its summary holds the range of speeds (\"held tables\").",
       "extrapolate = \"error\""},
      {"W13", "a steady response of an unstable rotor",
       "The steady response to unbalance or to a harmonic force is a motion about the equilibrium. "
       "At a speed where free motions grow it is never reached: oil whirl, divergence or another "
       "motion takes its place. Looked at are the middle and the end of the range and the highest "
       "response; a stability step finds the onset. Where nothing damps a resonance its amplitude "
       "has no "
       "bound, and a cracked rotor has no periodic motion in its bands of instability.",
       "[[step]]\ntype = \"stability\"\nspeed = { start = \"1000 rpm\", stop = \"9000 rpm\" }"},
      {"W14", "a mean of a stiffness that turns",
       "The rotor has unequal principal stiffnesses or moments of inertia, or a crack. Modes, "
       "critical speeds and harmonic responses are computed in fixed axes with their mean over a "
       "revolution, of a crack that of its compliance; a step at 0 rpm alone takes them at the "
       "angle at which the rotor lies. In truth unbalance meets two critical speeds, one a "
       "principal plane, and between them the rotor bends out: an unbalance response and a "
       "stability step are computed in axes that turn with the shaft and show both. Gears whose "
       "stiffness changes with their teeth, and rolling bearings, enter with their mean: where the "
       "frequency at which teeth or rolling elements pass, or a multiple of it, is the sum of two "
       "natural frequencies, motion may grow that linear analyses do not see. A stability step "
       "looks for that, to first order in the change of stiffness; a transient shows it.",
       "[[step]]\ntype = \"stability\"\nspeed = { start = \"1000 rpm\", stop = \"9000 rpm\" }"},
      {"W15", "a response that is not refined",
       "The points of a response over a range are made finer about natural frequencies or critical "
       "speeds, and these could not be found (a table that does not reach them, a mode that was "
       "lost). The response is right at the points asked for; a peak between two of them may be "
       "missed. More points help, or tables that cover the range.",
       "[[step]]\ntype = \"harmonic_response\"\nfrequency = { start = \"10 Hz\", stop = \"200 "
       "Hz\", "
       "points = 2000 }"},
      {"W16", "rows of a table that are far apart",
       "The coefficients of a bearing are interpolated between the rows of its table. Each row "
       "within "
       "the speeds of the step is left out once and interpolated from those beside it; a quarter "
       "of "
       "what that misses is the error to expect between rows as they are, and it exceeds 2 % of "
       "the "
       "largest coefficient of its kind. Critical speeds and onsets of instability follow the "
       "coefficients: more rows where they bend.",
       ""},
      {"W17", "a critical speed that separation margins leave out",
       "A lightly damped critical speed lies nearer to the operating range than its margin asks "
       "for, and no "
       "peak of the response says so: the speeds end before it, the unbalance does not drive it, "
       "or no probe "
       "sees it. The margins in the table do not cover it.",
       "[[step]]\ntype = \"unbalance_response\"\noperating_speed = [\"9000 rpm\", \"10000 "
       "rpm\"]\nspeed = { start = \"500 "
       "rpm\", stop = \"13000 rpm\", points = 100 }   # to 1.27 times the operating speed at "
       "least"},
      {"W18", "masses that the base does not shake",
       "The deck shakes its base, and has a foundation with internal coordinates that carry mass. "
       "Its matrices do not say which way an internal coordinate moves (a modal coordinate moves "
       "no one way), so the acceleration of the base has no force on its own mass: the motion of "
       "the foundation, and with it of the rotor, is smaller than it would be. The masses at the "
       "support points are shaken, and those that couple them with internal coordinates act on "
       "these.",
       ""},
      {"W19", "a material unlike any",
       "The modulus or the density of a material is no metal's, but would be one's in another "
       "unit: "
       "MPa for GPa, g/cm^3 for kg/m^3. It is computed as given. A shaft that is to have no mass "
       "has "
       "the density 0.",
       "E = \"210 GPa\"\ndensity = \"7850 kg/m^3\""},
      {"W20", "left out or assumed in a conversion",
       "What another program's file says and a deck has no word for, or what a deck needs and the "
       "file does not say. The same list stands at the head of the deck.",
       ""},
  };
  return t;
}

}  // namespace whirl
