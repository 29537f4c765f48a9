// What the program writes, number by number: deck, file, row, column, the value from a closed form,
// and where that comes from.
#include "deck_run.hpp"
#include "written_decks.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>
#include <set>

namespace {

using whirl::test::DeckRun;

struct Number {
  const char* deck;
  const char* file;
  int row;  ///< from 0; negative: from the end
  const char* column;
  double expected, tolerance;
  const char* why;
};

// Forces of the right part on the left one: r x F of the tip force about the section. The sag
// shortens the lever by 1e-6 of it.
const Number numbers[] = {
    {"cantilever", "st_sections.csv", 0, "V_y [N]", 200, 1e-3, "tip force"},
    {"cantilever", "st_sections.csv", 0, "V_z [N]", 50, 1e-3, "tip force"},
    {"cantilever", "st_sections.csv", 0, "M_z [N m]", 200, 1e-3, "F_y L, hollow towards +y"},
    {"cantilever", "st_sections.csv", 0, "M_y [N m]", -50, 1e-3, "-F_z L"},
    {"cantilever", "st_sections.csv", 0, "M [N m]", 206.1552812809, 1e-3, "resultant"},
    {"cantilever", "st_supports.csv", 0, "F_y [N]", -200, 1e-6, "reaction"},
    {"cantilever", "st_supports.csv", 0, "F_z [N]", -50, 1e-6, "reaction"},
    {"cantilever", "st_supports.csv", 0, "M_y [N m]", 50, 1e-3, "reaction: F_z L"},
    {"cantilever", "st_supports.csv", 0, "M_z [N m]", -200, 1e-3, "reaction: -F_y L"},
    // k a = 0.4 m (50 N cos a - 100 N sin a)
    {"arms at rest", "t.csv", -1, "joint H angle [rad]", 0.0192272602162008, 1e-10, "in balance"},
    {"arms at rest", "t.csv", -1, "joint H force.x [N]", -100, 1e-6, "weight"},
    {"arms at rest", "t.csv", -1, "joint H force.y [N]", -50, 1e-6, "the load"},
    {"arms at rest", "t.csv", -1, "joint H force.z [N]", -20, 1e-6, "the load"},
    {"arms at rest", "t.csv", -1, "joint H moment.x [N.m]", -0.153808604466866, 1e-7, "-(r x F)"},
    {"arms at rest", "t.csv", -1, "joint H moment.y [N.m]", 7.99852129541404, 1e-7, "-(r x F)"},
    {"arms at rest", "t.csv", -1, "joint H moment.z [N.m]", -19.2272602162008, 1e-7,
     "of the spring"},
    // the arm lies along the force: (cos b cos a, sin b cos a, -sin a)
    {"arms at rest", "t.csv", -1, "joint U angle [rad]", -0.365879669450817, 1e-10, "-asin F_z/F"},
    {"arms at rest", "t.csv", -1, "joint U second angle [rad]", 0.291456794477867, 1e-10,
     "atan F_y/F_x"},
    {"arms at rest", "t.csv", -1, "joint S slide [m]", 0.03, 1e-12, "F/k"},
    {"arms at rest", "t.csv", -1, "joint S moment.z [N.m]", -2, 1e-9, "5 N 0.4 m"},
    {"arms at rest", "st_joints.csv", 0, "F_x [N]", -100, 1e-6, "weight"},
    {"arms at rest", "st_joints.csv", 0, "F_y [N]", -50, 1e-6, "the load"},
    {"arms at rest", "st_joints.csv", 0, "F_z [N]", -20, 1e-6, "the load"},
    {"arms at rest", "st_joints.csv", 0, "M_x [N m]", -0.153808604466866, 1e-7, "-(r x F)"},
    {"arms at rest", "st_joints.csv", 0, "M_y [N m]", 7.99852129541404, 1e-7, "-(r x F)"},
    {"arms at rest", "st_joints.csv", 0, "M_z [N m]", -19.2272602162008, 1e-7, "of the spring"},
    {"arms at rest", "st_joints.csv", 0, "angle [rad]", 0.0192272602162008, 1e-10, "in balance"},
    {"arms at rest", "st_joints.csv", 1, "second angle [rad]", 0.291456794477867, 1e-10,
     "atan F_y/F_x"},
    {"arms at rest", "st_joints.csv", 2, "slide [m]", 0.03, 1e-12, "F/k"},
    {"arms in motion", "t.csv", -1, "joint H angle [rad]", 0.628183976187385, 1e-7,
     "M/c (t - I/c (1 - exp(-c t/I)))"},
    {"arms in motion", "t.csv", -1, "joint S slide [m]", 1.13533528323661, 1e-7,
     "F/c (t - m/c (1 - exp(-c t/m)))"},
    {"arm on an arm", "t.csv", -1, "joint A force.y [N]", -50, 1e-9, "the load"},
    {"arm on an arm", "t.csv", -1, "joint G moment.z [N.m]", -20, 1e-9, "50 N at 0.4 m"},
    // F (w/w_top)^2/(k - m w^2 + i c w)
    {"backward", "h_response.csv", 0, "P y amplitude [m]", 3.293230012334e-5, 1e-14,
     "a quarter of the force at half the top speed"},
    {"backward", "h_response.csv", 1, "P y amplitude [m]", 5.292516323279e-4, 1e-13,
     "the whole force"},
    {"backward", "h_response.csv", 0, "P y phase lag [deg]", 7.131778639309, 1e-9,
     "atan2(c w, k - m w^2)"},
    {"backward", "h_response.csv", 0, "P z phase lag [deg]", -82.868221360691, 1e-9,
     "backward: z leads y by a quarter"},
    {"backward", "h_response.csv", 1, "P major [m]", 5.292516323279e-4, 1e-13, "a circle"},
    {"backward", "h_response.csv", 1, "P minor [m]", -5.292516323279e-4, 1e-13,
     "run backward: negative"},
    {"backward", "h_response.csv", 1, "bearing spring force y [N]", 538.5718741681, 1e-8,
     "|k + i c w| times the amplitude"},
    // M/(k - Ip w^2 + i c w)
    {"twist", "h_response.csv", 0, "P twist amplitude [rad]", 1.174520832862e-3, 1e-13,
     "one degree of freedom"},
    {"twist", "h_response.csv", 0, "P twist phase lag [deg]", 8.487558102645, 1e-9,
     "lags: positive"},
    {"twist", "h_response.csv", 1, "P twist phase lag [deg]", 34.306291444409, 1e-9,
     "atan2(c w, k - Ip w^2)"},
    // peak of m_u w^2/|k - m w^2 + i c w| at w_n/sqrt(1 - 2 zeta^2), zeta = 600/(2 sqrt(k m));
    // there the lag is 95.468 deg behind the heavy spot
    {"unbalance", "u_peaks.csv", 0, "speed [rpm]", 3047.302992474, 1e-6, "w_n/sqrt(1 - 2 zeta^2)"},
    {"unbalance", "u_peaks.csv", 0, "amplitude [m]", 5.294341149915e-4, 1e-13, "closed form"},
    {"unbalance", "u_peaks.csv", 0, "phase lag [deg]", 35.468479891, 1e-6,
     "95.468 less the 60 deg of the unbalance: behind the mark"},
    // y = F/k (1 - exp(-zeta w t)(cos w_d t + zeta w/w_d sin w_d t)); tolerance of the integrator
    // 1e-9 of the motion, with a margin
    {"limited", "t.csv", -1, "t [s]", 6.0575050235066e-3, 1e-9, "the first passage of 1.2 mm"},
    {"limited", "t.csv", -1, "P.y [m]", 1.2e-3, 1e-9, "the limit"},
    {"short steps", "t.csv", -1, "P.y [m]", 4.5056184569988e-4, 1e-9, "step response at 20 ms"},
    {"modes", "m_energy.csv", 0, "share [%]", 100, 1e-9, "one spring"},
    {"modes", "m_energy.csv", 1, "share [%]", 100, 1e-9, "one disk"},
    // |H|^2 at half of its peak where (w_n/w)^2 = 1 - 2 zeta^2 -+ 2 zeta sqrt(1 - zeta^2):
    // N1 = 2790.7 rpm, N2 = 3390.8 rpm
    {"operated below the peak", "u_margins.csv", 0, "amplification factor [-]", 5.078092979906,
     1e-7, "Nc/(N2 - N1)"},
    {"operated below the peak", "u_margins.csv", 0, "required [%]", 22.24886577977, 1e-6,
     "API RP 684, above the range: 10 + 17 (1 - 1/(AF - 1.5))"},
    {"operated below the peak", "u_margins.csv", 0, "actual [%]", 52.36514961846, 1e-6,
     "of 2000 rpm"},
    {"operated above the peak", "u_margins.csv", 0, "peak [rpm]", 3047.302992369, 1e-5, "the peak"},
    {"operated above the peak", "u_margins.csv", 0, "required [%]", 12.24886577977, 1e-6,
     "API RP 684, below the range: 17 (1 - 1/(AF - 1.5))"},
    {"operated above the peak", "u_margins.csv", 0, "actual [%]", 23.81742519077, 1e-6,
     "of 4000 rpm"},
    {"operated at the peak", "u_margins.csv", 0, "actual [%]", -1.552290418366, 1e-6,
     "inside: negative, of the peak"},
    // F L^3/(3 E I) + F L/(kappa G A); slopes of 3e-4 leave 1e-7 of it
    {"short rectangle", "st_deflection.csv", -1, "u_y [m]", 4.282407407407e-5, 5e-11,
     "bends about z, kappa_y: 4.375e-5 with kappa_z"},
    {"short rectangle", "st_deflection.csv", -1, "u_z [m]", 2.060185185185e-5, 5e-11,
     "bends about y, kappa_z"},
    // pi/2 sqrt(E I/(29.2 kg/m)); 16 elements and the shear factor leave 1e-6
    {"laden rectangle", "m_modes.csv", 0, "frequency [Hz]", 73.53912163982, 2e-4, "I_z"},
    {"laden rectangle", "m_modes.csv", 1, "frequency [Hz]", 110.3086824597, 2e-4, "I_y"},
    // m v + c2 y^3/3 stays
    {"damping2", "t.csv", -1, "P.y [m]", 0.01, 1e-9, "(3 m v/c2)^(1/3)"},
    {"damping2 of the twist", "t.csv", -1, "P phi [rad]", 1, 1e-7, "(3 Ip w/c2)^(1/3)"},
    {"ball bearing pushed along", "t.csv", -1, "P position.x [m]", 0.10004006737947, 1e-11,
     "0.1 m + F/c (t - m/c (1 - exp(-c t/m))): within its play"},
    {"roller bearing pushed along", "t.csv", -1, "P position.x [m]", 0.10004006737947, 1e-11,
     "the same, without any play"},
    // (k - m w^2) y = k p; (k + K - M w^2) p - i w C p' = k y
    {"coupled casing", "h_response.csv", 0, "P y amplitude [m]", 2.873071864957560e-4, 1e-15,
     "four equations"},
    {"coupled casing", "h_response.csv", 0, "Q y amplitude [m]", 2.867013095516208e-5, 1e-16,
     "moved through the damping alone"},
    {"coupled casing", "h_response.csv", 0, "Q y phase lag [deg]", -90, 1e-9, "i w C"},
    {"window", "t.csv", 0, "t [s]", 5e-3, 1e-15, "rows from the first time of the window"},
    {"window", "t.csv", -1, "t [s]", 10e-3, 1e-15, "to the second"},
    // m_u w^2/(k - m w^2 + i c w) at 50 Hz, a line of the spectrum
    {"circle", "t_P_spectra.csv", 0, "50 Hz [m]", 5.223504239706786e-4, 1e-10, "forward"},
    {"circle", "t_P_spectra.csv", 0, "48 Hz [m]", 2.611752119853393e-4, 1e-10,
     "half of it beside the line: the window of Hann"},
    {"circle", "t_P_spectra.csv", 0, "46 Hz [m]", 0, 1e-10, "none two lines away"},
    {"circle", "t_P_spectra.csv", 0, "-50 Hz [m]", 0, 1e-10, "nothing backward"},
    {"circle", "t_P_ridge.csv", 0, "t [s]", 0.2490234375, 1e-12, "middle of the block"},
    {"circle", "t_P_ridge.csv", 0, "speed [rpm]", 3000, 1e-6, "the drive's"},
    {"circle", "t_P_ridge.csv", 0, "change of speed [rpm]", 0, 1e-6, "constant"},
    {"circle", "t_P_ridge.csv", 0, "frequency [Hz]", 50, 1e-6, "the strongest line"},
    {"circle", "t_P_ridge.csv", 0, "amplitude [m]", 5.223504239706786e-4, 1e-10, "its height"},
    {"circle", "t_P_ridge.csv", 0, "equal angles [-]", 0, 0.1, "no need of them"},
    {"circle", "t_P_spectra.csv", 0, "speed [rpm]", 3000, 1e-6, "the drive's"},
    {"circle", "t_tracking.csv", -1, "P.y 1X [m]", 5.223504239706786e-4, 1e-10, "the circle"},
    {"circle", "t_tracking.csv", -1, "P.y 1X lag [deg]", 86.04275345171, 1e-4,
     "atan2(c w, k - m w^2)"},
    {"circle", "t_tracking.csv", -1, "P.z 1X lag [deg]", 176.04275345171, 1e-4, "a quarter later"},
    {"circle", "t_tracking.csv", -1, "P.y 2X [m]", 0, 1e-10, "linear"},
    {"circle", "t_tracking.csv", -1, "P.y mean [m]", 0, 1e-10, "no weight"},
    {"circle", "t_tracking.csv", -1, "P 1X forward [m]", 5.223504239706786e-4, 1e-10, "forward"},
    {"circle", "t_tracking.csv", -1, "P 1X backward [m]", 0, 1e-10, "nothing backward"},
    {"circle of a shaft that turns backward", "t_P_spectra.csv", 0, "50 Hz [m]",
     5.223504239706786e-4, 1e-10, "with the spin: positive"},
    {"circle of a shaft that turns backward", "t_P_spectra.csv", 0, "-50 Hz [m]", 0, 1e-10,
     "nothing against it"},
    {"circle of a shaft that turns backward", "t_tracking.csv", -1, "speed [rpm]", -3000, 1e-6,
     "the drive's"},
    {"circle of a shaft that turns backward", "t_tracking.csv", -1, "P 1X forward [m]",
     5.223504239706786e-4, 1e-10, "with the spin: forward"},
    {"circle of a shaft that turns backward", "t_tracking.csv", -1, "P 1X backward [m]", 0, 1e-10,
     "nothing against it"},
    // v + w x r, 100 mm and 200 mm from the left end
    {"turned about the left end", "t.csv", 0, "P velocity.y [m/s]", 0.4, 1e-14, "0.1 + w_z r"},
    {"turned about the left end", "t.csv", 0, "P velocity.z [m/s]", -0.2, 1e-14, "-w_y r"},
    {"turned about the left end", "t.csv", 0, "far velocity.y [m/s]", 0.7, 1e-14, "0.1 + w_z r"},
    {"turned about the left end", "t.csv", 0, "far velocity.z [m/s]", -0.4, 1e-14, "-w_y r"},
    {"turned about the left end", "t.csv", 0, "speed [rpm]", 66.845076098596, 1e-10, "7 rad/s"},
    // the axis, tilted 30 degrees about y: (cos, 0, -sin)
    {"tilted", "t.csv", 0, "speed [rpm]", 731.500377277551, 1e-10, "omega along the axis"},
    {"events", "t_events.csv", 0, "time [s]", 0.5, 1e-11, "w Ip/T"},
    {"events", "t_events.csv", 0, "speed [rpm]", 47.746482927569, 1e-8, "5 rad/s"},
    {"events", "t.csv", -1, "drive motor torque [N.m]", 1, 1e-14, "given"},
    {"events", "t.csv", -1, "speed [rpm]", 95.492965855137, 1e-9, "T t/Ip"},
    {"events", "t.csv", -1, "phi [rad]", 5, 1e-11, "T t^2/(2 Ip)"},
    {"limited", "t.csv", -1, "energy.kinetic [J]", 0.31263343806, 1e-7, "m v^2/2"},
    {"limited", "t.csv", -1, "energy.elastic [J]", 0.72, 1e-7, "k y^2/2"},
    {"unbalance", "u_peaks.csv", 0, "order [-]", 1, 0, "unbalance"},
    {"unbalance", "u_peaks.csv", 0, "amplification factor [-]", 5.078092979906, 1e-7,
     "Nc/(N2 - N1)"},
    {"unbalance", "u_peaks.csv", 0, "N1 [rpm]", 2790.711991095, 1e-5, "half power below"},
    {"unbalance", "u_peaks.csv", 0, "N2 [rpm]", 3390.800056522, 1e-5, "half power above"},
    // at 1000 rpm: 4.0367 deg behind the heavy spot, which leads by 60 deg
    {"unbalance", "u_response.csv", 0, "speed [rpm]", 1000, 1e-9, "asked for"},
    {"unbalance", "u_response.csv", 0, "P y amplitude [m]", 1.228637304431e-5, 1e-17,
     "closed form"},
    {"unbalance", "u_response.csv", 0, "P y phase lag [deg]", -55.963282930293, 1e-9,
     "atan2(c w, k - m w^2) - 60"},
    {"unbalance", "u_response.csv", 0, "P z amplitude [m]", 1.228637304431e-5, 1e-17, "a circle"},
    {"unbalance", "u_response.csv", 0, "P z phase lag [deg]", 34.036717069707, 1e-9,
     "a quarter later"},
    {"probe at 45 degrees", "u_response.csv", 0, "P 45deg amplitude [m]", 1.228637304431e-5, 1e-17,
     "a circle"},
    {"probe at 45 degrees", "u_response.csv", 0, "P 45deg phase lag [deg]", -10.963282930293, 1e-9,
     "an eighth of a turn after y"},
    {"unbalance", "u_response.csv", 0, "P major [m]", 1.228637304431e-5, 1e-17, "a circle"},
    {"unbalance", "u_response.csv", 0, "P minor [m]", 1.228637304431e-5, 1e-17,
     "run forward: positive"},
    {"unbalance", "u_response.csv", 0, "bearing spring force y [N]", 12.310601483651, 1e-11,
     "|k + i c w| times the amplitude"},
    {"unbalance", "u_response.csv", 0, "bearing spring force y phase lag [deg]", 120.441443289839,
     1e-9, "against the motion, which the damper leads by atan2(c w, k)"},
    {"unbalance", "u_response.csv", 0, "bearing spring force z [N]", 12.310601483651, 1e-11,
     "a circle"},
    {"unbalance", "u_response.csv", 0, "bearing spring force z phase lag [deg]", -149.558556710161,
     1e-9, "a quarter later"},
    // w_n sqrt(1 - zeta^2), 2 pi zeta/sqrt(1 - zeta^2), zeta = 600/(2 sqrt(k m)); along the axis
    // zeta = 10/(2 sqrt(krxx Ip))
    {"campbell", "c_campbell.csv", 1, "speed [rpm]", 6000, 1e-9, "asked for"},
    {"campbell", "c_campbell.csv", 1, "1 F frequency [Hz]", 50.102218760639, 1e-9, "damped"},
    {"campbell", "c_campbell.csv", 1, "1 F log decrement [-]", 0.598775877438, 1e-10, "damped"},
    {"campbell", "c_campbell.csv", 1, "1 F damping ratio [-]", 0.094868329805, 1e-11, "zeta"},
    {"campbell", "c_critical_speeds.csv", 0, "order [-]", 1, 0, "the default"},
    {"campbell", "c_critical_speeds.csv", 0, "speed [rpm]", 3006.133125638, 1e-7,
     "of the damped frequency"},
    {"campbell", "c_critical_speeds.csv", 0, "frequency [Hz]", 50.102218760639, 1e-9, "damped"},
    {"campbell", "c_critical_speeds.csv", 0, "log decrement [-]", 0.598775877438, 1e-10, "damped"},
    {"campbell", "c_critical_speeds.csv", 0, "damping ratio [-]", 0.094868329805, 1e-11, "zeta"},
    {"campbell", "v_undamped.csv", 0, "order [-]", 1, 0, "the default"},
    {"campbell", "v_undamped.csv", 1, "number [-]", 2, 0, "one a plane"},
    {"campbell", "v_undamped.csv", 0, "speed [rpm]", 3019.752726269, 1e-7, "w_n"},
    {"campbell", "v_undamped.csv", 0, "frequency [Hz]", 50.329212104487, 1e-9, "w_n"},
    {"campbell", "v_damped.csv", 0, "order [-]", 1, 0, "the default"},
    {"campbell", "v_damped.csv", 1, "number [-]", 2, 0, "one a plane"},
    {"campbell", "v_damped.csv", 0, "speed [rpm]", 3006.133125638, 1e-7, "the damped frequency"},
    {"campbell", "v_damped.csv", 0, "frequency [Hz]", 50.102218760639, 1e-9, "damped"},
    {"campbell", "v_damped.csv", 0, "log decrement [-]", 0.598775877438, 1e-10, "damped"},
    {"campbell", "v_damped.csv", 0, "damping ratio [-]", 0.094868329805, 1e-11, "zeta"},
    {"campbell", "v_damped.csv", 0, "amplification [-]", 5.270462766947, 1e-10, "1/(2 zeta)"},
    {"campbell", "p_critical_map.csv", 0, "stiffness [N/m]", 1e6, 1e-6, "asked for"},
    {"campbell", "p_critical_map.csv", 0, "critical 1 [rpm]", 3019.752726269, 1e-7, "sqrt(k/m)"},
    {"campbell", "p_critical_map.csv", 1, "critical 1 [rpm]", 6039.505452538, 1e-7,
     "twice that at four times the stiffness"},
    {"campbell", "o_torsional.csv", 0, "mode [-]", 1, 0, "the first"},
    {"campbell", "o_torsional.csv", 0, "frequency [Hz]", 49.696115052205, 1e-9, "damped"},
    {"campbell", "o_torsional.csv", 0, "frequency [rpm]", 2981.766903132, 1e-7, "60 times that"},
    {"campbell", "o_torsional.csv", 0, "log decrement [-]", 1.006114863254, 1e-10, "damped"},
    {"campbell", "o_torsional.csv", 0, "damping ratio [-]", 0.158113883008, 1e-11, "zeta"},
    {"campbell", "m_modes.csv", 0, "frequency [Hz]", 49.696115052205, 1e-9, "damped"},
    {"campbell", "m_modes.csv", 0, "frequency [rpm]", 2981.766903132, 1e-7, "60 times that"},
    {"campbell", "m_modes.csv", 0, "log decrement [-]", 1.006114863254, 1e-10, "damped"},
    {"campbell", "m_modes.csv", 0, "damping ratio [-]", 0.158113883008, 1e-11, "zeta"},
    {"campbell", "m_modes.csv", 0, "torsional [%]", 100, 1e-9, "twist alone"},
    {"campbell", "m_modes.csv", 0, "lateral [%]", 0, 1e-9, "twist alone"},
    {"campbell", "m_modes.csv", 0, "axial [%]", 0, 1e-9, "twist alone"},
    {"campbell", "m_modes.csv", 0, "mode [-]", 1, 0, "the first"},
    {"campbell", "m_modes.csv", 0, "mesh error [-]", 0, 1e-12, "no elements"},
    {"campbell", "m_energy.csv", 1, "mode [-]", 1, 0, "the first"},
    {"campbell", "m_energy_parts.csv", 0, "mode [-]", 1, 0, "the first"},
    {"campbell", "m_energy_parts.csv", 0, "kinetic: mass [%]", 100, 1e-9, "one disk"},
    {"campbell", "m_energy_parts.csv", 0, "strain: guide, spring [%]", 100, 1e-9, "one spring"},
    // m l^2 + c l + k - i q = 0 of y + i z, q = 2 c w_n (speed/6000 rpm)
    {"speed-coupled", "s_log_decrement.csv", 0, "speed [rpm]", 1500, 1e-9, "asked for"},
    {"speed-coupled", "s_log_decrement.csv", 0, "1 F log decrement [-]", 0.298034234047, 1e-10,
     "driven"},
    {"speed-coupled", "s_log_decrement.csv", 0, "1 B log decrement [-]", 0.898151163936, 1e-10,
     "held back"},
    {"speed-coupled", "s_log_decrement.csv", 1, "1 F damping ratio [-]", -0.090880872758, 1e-10,
     "grows"},
    {"speed-coupled", "s_log_decrement.csv", 1, "1 B frequency [Hz]", 50.981400619216, 1e-9,
     "of both"},
    {"speed-coupled", "s_map.csv", 0, "speed [rpm]", 1500, 1e-9, "asked for"},
    {"speed-coupled", "s_map.csv", 0, "c = 300 N.s/m [-]", 0, 1e-10, "its onset"},
    {"speed-coupled", "s_map.csv", 1, "c = 600 N.s/m [-]", -0.573394200922, 1e-10, "the least"},
    {"speed-coupled", "s_map_onset.csv", 0, "c [N.s/m]", 300, 1e-10, "asked for"},
    {"speed-coupled", "s_map_onset.csv", 0, "onset speed [rpm]", 1500, 1e-6, "q = c w_n"},
    {"speed-coupled", "s_map_onset.csv", 0, "whirl frequency [Hz]", 50.329212104487, 1e-8, "w_n"},
    {"speed-coupled", "s_onset.csv", 0, "speed [rpm]", 3000, 1e-6, "q = c w_n"},
    {"speed-coupled", "s_onset.csv", 0, "whirl frequency [Hz]", 50.329212104487, 1e-8, "w_n"},
    {"speed-coupled", "s_onset.csv", 0, "frequency / speed [-]", 1.00658424209, 1e-9,
     "w_n by 50 Hz"},
    {"speed-coupled", "s_verdicts.csv", 0, "growing whirl modes [-]", 0, 0, "below the onset"},
    {"speed-coupled", "s_verdicts.csv", 1, "speed [rpm]", 6000, 1e-9, "asked for"},
    {"speed-coupled", "s_verdicts.csv", 1, "growing whirl modes [-]", 1, 0, "the forward one"},
    {"speed-coupled", "s_verdicts.csv", 1, "diverging motions [-]", 0, 0, "it whirls"},
    {"speed-coupled", "s_verdicts.csv", 1, "fastest growth [1/s]", 29.232439469915, 1e-8,
     "the real part of the root"},
    {"speed-coupled", "s_verdicts.csv", 1, "roots not found [-]", 0, 0, "four in all"},
    // 1 kN on (k, q; -q, k) with q = 189,737 N/m; threshold: m w_n^2 = k with q = c w_n
    {"speed-coupled", "e_coefficients.csv", 0, "speed [rpm]", 3000, 1e-9, "asked for"},
    {"speed-coupled", "e_coefficients.csv", 0, "load [N]", 1000, 1e-9, "the load"},
    {"speed-coupled", "e_coefficients.csv", 0, "y [m]", 9.652509652510e-4, 1e-14,
     "F k/(k^2 + q^2)"},
    {"speed-coupled", "e_coefficients.csv", 0, "z [m]", 1.831434938321e-4, 1e-14,
     "F q/(k^2 + q^2)"},
    {"speed-coupled", "e_coefficients.csv", 0, "eccentricity [m]", 9.824718648648e-4, 1e-14,
     "F/sqrt(k^2 + q^2)"},
    {"speed-coupled", "e_coefficients.csv", 0, "attitude [deg]", 10.743403801776, 1e-9,
     "atan2(q, k)"},
    {"speed-coupled", "e_coefficients.csv", 0, "kyy [N/m]", 1e6, 1e-5, "the table"},
    {"speed-coupled", "e_coefficients.csv", 0, "kyz [N/m]", 189736.659610103, 1e-6, "half way"},
    {"speed-coupled", "e_coefficients.csv", 0, "kzy [N/m]", -189736.659610103, 1e-6, "half way"},
    {"speed-coupled", "e_coefficients.csv", 0, "kzz [N/m]", 1e6, 1e-5, "the table"},
    {"speed-coupled", "e_coefficients.csv", 0, "cyy [N s/m]", 600, 1e-9, "the table"},
    {"speed-coupled", "e_coefficients.csv", 0, "cyz [N s/m]", 0, 1e-9, "the table"},
    {"speed-coupled", "e_coefficients.csv", 0, "czy [N s/m]", 0, 1e-9, "the table"},
    {"speed-coupled", "e_coefficients.csv", 0, "czz [N s/m]", 600, 1e-9, "the table"},
    {"speed-coupled", "e_coefficients.csv", 0, "threshold mass [kg]", 10, 1e-9,
     "3000 rpm is the onset of 10 kg"},
    {"speed-coupled", "e_coefficients.csv", 0, "whirl / speed [-]", 1.00658424209, 1e-10,
     "w_n by 50 Hz"},
    {"speed-coupled", "e_equilibria.csv", 0, "speed [rpm]", 3000, 1e-9, "asked for"},
    {"speed-coupled", "e_equilibria.csv", 0, "equilibrium [-]", 1, 0, "found"},
    {"speed-coupled", "e_equilibria.csv", 0, "unstable directions [-]", 0, 0, "stiff both ways"},
    {"speed-coupled", "e_equilibria.csv", 0, "symmetric tangent [-]", 0, 0, "q"},
    // pi^2 E I/4 in kN; as the column shortens by P/EA, P (1 - P/EA) is that
    {"struts", "b_buckling.csv", 1, "mode [-]", 2, 0, "the second"},
    {"struts", "b_buckling.csv", 0, "on the path [-]", 157.96566, 1e-4, "I_z"},
    {"struts", "b_buckling.csv", 0, "load factor [-]", 157.91367, 0.1, "I_z"},
    {"struts", "b_buckling.csv", 1, "load factor [-]", 355.30576, 0.5, "I_y"},
    {"struts", "b_buckling.csv", 0, "imaginary part [-]", 0, 0, "conservative"},
    {"struts", "b_buckling.csv", 0, "displacement before [-]", 3.29e-4, 3e-7,
     "shortened by P/EA of its length"},
    {"struts", "b_buckling.csv", 0, "rotation before [rad]", 0, 1e-12, "straight"},
    {"path", "st_path.csv", 0, "load factor [-]", 0, 0, "no load"},
    {"path", "st_path.csv", -1, "load factor [-]", 2, 1e-9, "its end"},
    {"path", "st_path.csv", -1, "limit point [-]", 0, 0, "none"},
    {"path", "st_path.csv", -1, "bifurcation [-]", 0, 0, "none"},
    {"path", "st_path.csv", -1, "unstable directions [-]", 0, 0, "none"},
    {"path", "st_path.csv", -1, "P u_y [m]", 2e-4, 1e-13, "twice 100 N on 1e6 N/m"},
    {"path", "st_path.csv", -1, "P u_x [m]", 0, 1e-15, "along y alone"},
    {"path", "st_path.csv", -1, "P u_z [m]", 0, 1e-15, "along y alone"},
    {"path", "st_path.csv", -1, "P phi [rad]", 0, 1e-15, "along y alone"},
    // w^2 = k/m - c^2/(2 m^2), F/(c sqrt(k/m - c^2/(4 m^2)))
    {"harmonic peaks", "h_peaks.csv", 0, "frequency [Hz]", 49.87419230844, 1e-5, "of the peak"},
    {"harmonic peaks", "h_peaks.csv", 0, "amplitude [m]", 5.294341149914966e-5, 1e-14,
     "of the peak"},
    // from rest: the whirl that stays and the one that dies out
    {"orbits", "t_orbits.csv", 0, "time [s]", 0.09, 1e-9, "middle of the turn that ends at 0.1 s"},
    {"orbits", "t_orbits.csv", 0, "y [m]", 2.676047426838e-5, 1e-12, "at 0.06 s"},
    {"orbits", "t_orbits.csv", 0, "z [m]", -4.349437597724e-4, 1e-12, "at 0.06 s"},
    {"orbits", "t_orbits.csv", 1, "y [m]", 1.926120942096e-4, 1e-12, "22.5 degrees on"},
    {"orbits", "t_orbits.csv", 8, "z [m]", 4.572815465776e-4, 1e-12, "half a turn on"},
    {"orbits", "t_orbits.csv", 32, "z [m]", -4.951705166536e-4, 1e-12, "at 0.1 s"},
    // two turns of 16 intervals
    {"orbits", "t_orbits.csv", 32, "angle [deg]", 720, 1e-9, "the 33rd point ends the second turn"},
    {"orbits", "t_orbits.csv", -1, "angle [deg]", 720, 1e-9, "and is the last"},
    {"orbits", "t_orbits.csv", 17, "angle [deg]", 382.5, 1e-9, "the seam is there once"},
    {"limited", "t.csv", -1, "P.z [m]", 0, 1e-15, "pushed along y"},
    {"turned about the left end", "t.csv", 0, "far velocity.x [m/s]", 0, 1e-15, "w x r across"},
    {"turned about the left end", "t.csv", 0, "far position.y [m]", 0, 1e-15, "not tilted yet"},
    {"turned about the left end", "t.csv", 0, "far position.z [m]", 0, 1e-15, "not tilted yet"},
    {"tilted", "t.csv", 0, "P gamma.2 [rad]", 0.523598775598, 1e-12, "30 degrees"},
    {"tilted", "t.csv", 0, "P gamma.3 [rad]", 0, 1e-15, "about y alone"},
    {"damping2 of the twist", "t.csv", 0, "P omega_phi [rad/s]", 10, 1e-12, "given"},
    {"short rectangle", "st_deflection.csv", -1, "s [m]", 0.2, 1e-15, "the tip"},
    {"short rectangle", "st_deflection.csv", -1, "slope_y [rad]", 3.125e-4, 1e-9, "F L^2/(2 E Iz)"},
    {"short rectangle", "st_deflection.csv", -1, "slope_z [rad]", 1.388888889e-4, 1e-9,
     "F L^2/(2 E Iy)"},
    {"short rectangle", "st_supports.csv", 0, "F_x [N]", 0, 1e-9, "across alone"},
    {"short rectangle", "st_supports.csv", 0, "M_x [N m]", -0.02222222222, 1e-7,
     "the forces at the moved tip: -(u_y F_z - u_z F_y)"},
    {"cantilever", "st_deflection.csv", -1, "phi [rad]", 0, 1e-9, "forces through the axis"},
    {"cantilever", "st_sections.csv", 0, "s [m]", 0, 0, "at the wall"},
    {"cantilever", "st_sections.csv", 0, "N [N]", 0, 1e-9, "across alone"},
    {"cantilever", "st_sections.csv", 0, "T [N m]", 0, 1e-9, "forces through the axis"},
    {"cantilever", "st_sections.csv", 0, "axial stress [Pa]", 0, 1e-6, "across alone"},
    {"cantilever", "st_sections.csv", 0, "bending stress [Pa]", 16799043.61, 50, "32 M/(pi d^3)"},
    {"cantilever", "st_sections.csv", 0, "torsion stress [Pa]", 0, 1e-6, "no torque"},
    {"cantilever", "st_sections.csv", 0, "von Mises stress [Pa]", 16799043.61, 50, "bending alone"},
    {"circle", "t_P_spectra.csv", 0, "t [s]", 0.2490234375, 1e-12,
     "256 samples in 0.5 s: half of 255 intervals"},
    {"circle", "t_tracking.csv", -1, "t [s]", 1.09, 1e-9, "middle of the last turn of 1.1 s"},
    {"circle", "t_tracking.csv", -1, "P.z 1X [m]", 5.223504239706786e-4, 1e-10, "the circle"},
    {"circle", "t_tracking.csv", -1, "P.z 2X [m]", 0, 1e-10, "linear"},
    {"circle", "t_tracking.csv", -1, "P.z mean [m]", 0, 1e-10, "no weight"},
    {"orbits", "t_orbits.csv", 0, "speed [rpm]", 3000, 1e-6, "the drive's"},
};

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream out;
  out << std::ifstream(file).rdbuf();
  return out.str();
}

}  // namespace

TEST(WrittenNumbers, AreThoseOfClosedForms) {
  for (const auto& [name, deck] : whirl::test::written_decks()) {
    const DeckRun run(deck);
    ASSERT_EQ(run.exit, 0) << name << "\n" << run.log;
    for (const Number& n : numbers) {
      if (n.deck != name) continue;
      const auto csv = run.csv(n.file);
      const std::size_t row = n.row < 0 ? csv.rows.size() - static_cast<std::size_t>(-n.row)
                                        : static_cast<std::size_t>(n.row);
      ASSERT_LT(row, csv.rows.size()) << name << " " << n.file;
      EXPECT_NEAR(csv.rows[row][csv.column(n.column)], n.expected, n.tolerance)
          << name << ", " << n.file << ", " << n.column << ": " << n.why;
    }
    if (name == "short steps") {  // 20 ms in steps of at most 0.1 ms
      const std::string summary = text_of(run.folder / "r" / "summary.json");
      EXPECT_NE(summary.find("\"step max [s]\": 0.0001"), std::string::npos) << summary;
    }
    if (name == "limited") {
      EXPECT_TRUE(run.says("amplitude limit exceeded")) << run.log;
      const whirl::io::Value told = run.summary("t");
      EXPECT_EQ(told.at("outcome").text(), "amplitude limit exceeded");
      EXPECT_TRUE(told.at("detail").text().starts_with("P passes 0.0012 m at t = 0.0060575"))
          << told.at("detail").text();
    }
    if (name == "modes") {  // a spring stores strain, a disk moves
      const std::string shares = text_of(run.folder / "r" / "m_energy.csv");
      EXPECT_NE(shares.find("1,strain,linear bearings"), std::string::npos) << shares;
      EXPECT_NE(shares.find("1,kinetic,rigid disks"), std::string::npos) << shares;
    }
  }
}

// Stiffness of a bearing about its own place does not depend on where the node is that carries it.
TEST(WrittenNumbers, StiffnessOfABallBearingIsThatOfItsPlace) {
  const auto decks = whirl::test::written_decks();
  const auto stiffness_of = [&](const char* deck) {  // one run at a time: they share a folder
    return DeckRun(decks.at(deck)).csv("st_rolling_stiffness.csv");
  };
  const auto a = stiffness_of("ball bearing at its node"),
             b = stiffness_of("ball bearing off its node");
  ASSERT_EQ(a.rows.size(), 5u);
  ASSERT_EQ(b.rows.size(), 5u);
  // rows and columns x, y, z, ry, rz; columns 0 and 1 are words
  const double force = a.rows[1][3], arm = 0.025;  // N/m; the pitch radius
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = 0; j < 5; ++j)
      EXPECT_NEAR(a.rows[i][2 + j], b.rows[i][2 + j],
                  1e-12 * force * (i < 3 ? 1 : arm) * (j < 3 ? 1 : arm))
          << i << " " << j;
  EXPECT_GT(std::abs(a.rows[1][6]), 1e-3 * force * arm);  // a push across tilts: an arm would show
}

namespace {

/// "st_sections.csv" -> "sections"; the history of a step: "history".
std::string kind_of(const std::string& file) {
  const std::string stem = file.substr(0, file.rfind('.'));
  const std::size_t end_of_step = stem.find('_');
  return end_of_step == std::string::npos ? "history" : stem.substr(end_of_step + 1);
}

/// Heading without what a deck names and counts: "P.y 1X [m]" -> "#.y 1X [m]".
std::string general(std::string heading, const std::string& deck) {
  std::vector<std::string> names;
  const std::regex name("name = \"([^\"]*)\"");
  for (std::sregex_iterator i(deck.begin(), deck.end(), name), end; i != end; ++i)
    names.push_back((*i)[1]);
  std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() > b.size() : a < b;
  });
  for (const char* column : {"t", "s", "u"})  // time, place and displacement are called so too
    std::erase(names, column);
  for (const std::string& n : names)  // whole words, but the unit
    heading = std::regex_replace(heading, std::regex("(^|[ :,])" + n + "($|[ .,_])"), "$1#$2");
  heading = std::regex_replace(heading, std::regex("^[0-9]+ [FB] "), "mode ");
  heading = std::regex_replace(heading, std::regex("^critical [0-9]+"), "critical");
  heading = std::regex_replace(heading, std::regex("^(c = .*|c) \\[.*"), "parameter");
  return std::regex_replace(heading, std::regex("^-?[0-9.]+ Hz"), "line");
}

/// A name or a word in a table.
struct Word {
  const char* deck;
  const char* file;
  std::size_t row;  ///< from 0
  const char* column;
  const char* expected;
};

const Word words[] = {
    {"ball bearing at its node", "st_coefficients.csv", 0, "bearing [-]", "ball"},
    {"ball bearing at its node", "st_supports.csv", 0, "support [-]", "guide"},
    {"ball bearing at its node", "st_supports.csv", 1, "support [-]", "ball"},
    {"arms at rest", "st_deflection.csv", 0, "shaft [-]", "h"},
    {"arms at rest", "st_deflection.csv", 5, "shaft [-]", "s"},
    {"arms at rest", "st_deflection.csv", 0, "station [-]", "h1:start, joint 'H'"},
    {"arms at rest", "st_deflection.csv", 3, "station [-]", "u1:end, disk 'du', load 'load 2'"},
    {"arms at rest", "st_joints.csv", 0, "joint [-]", "H"},
    {"arms at rest", "st_joints.csv", 2, "joint [-]", "S"},
    {"cantilever", "st_sections.csv", 1, "shaft [-]", "r"},
    {"cantilever", "st_sections.csv", 4, "element [-]", "0"},
    {"cantilever", "st_sections.csv", 5, "element [-]", "1"},
    {"modes", "m_energy.csv", 0, "energy [-]", "strain"},
    {"modes", "m_energy.csv", 0, "part [-]", "linear bearings"},
    {"modes", "m_energy.csv", 1, "energy [-]", "kinetic"},
    {"modes", "m_energy.csv", 1, "part [-]", "rigid disks"},
    {"modes", "m_energy.csv", 0, "from [-]", "node at 0.1 m of shaft 'rotor'"},
    {"modes", "m_energy.csv", 0, "to [-]", ""},
    {"laden rectangle", "m_energy.csv", 1, "from [-]", "node at 0.0625 m of shaft 'r'"},
    {"laden rectangle", "m_energy.csv", 1, "to [-]", "node at 0.125 m of shaft 'r'"},
    {"events", "t_events.csv", 0, "event [-]", "five"},
    {"events", "t_events.csv", 0, "passage [-]", "rising"},
    {"operated above the peak", "u_margins.csv", 0, "probe [-]", "P"},
    {"operated above the peak", "u_margins.csv", 0, "result [-]", "passed"},
    {"operated at the peak", "u_margins.csv", 0, "result [-]", "FAILED"},
    {"orbits", "t_orbits.csv", 0, "probe [-]", "P"},
    {"harmonic peaks", "h_peaks.csv", 0, "probe [-]", "P"},
};

/// Cells of a CSV file, headings first.
std::vector<std::vector<std::string>> cells_of(const std::filesystem::path& csv) {
  std::vector<std::vector<std::string>> out;
  std::ifstream in(csv);
  for (std::string line; std::getline(in, line);) {
    out.push_back(whirl::test::Columns::cells_of(line));
    if (line.ends_with(',')) out.back().emplace_back();  // the last cell is empty
  }
  return out;
}

struct Elsewhere {
  const char* kind;
  const char* heading;
  const char* where;
};

/// Columns that no row of `numbers` reads, and what reads them; "open": nothing does yet.
const Elsewhere elsewhere[] = {
    {"campbell", "mode direction [-]", "app/test_direction.cpp"},
    {"coefficients", "Sommerfeld number [-]", "app/test_support_decks.cpp, test_step_speeds.cpp"},
    {"coefficients", "eccentricity / clearance [-]",
     "app/test_support_decks.cpp, test_step_speeds.cpp"},
    {"coefficients", "grid error [-]", "app/test_static_speeds.cpp"},
    {"coefficients", "axial error [-]", "app/test_recessed_journals.cpp"},
    {"coefficients", "heat error [-]", "app/test_hot_films.cpp"},
    {"critical_speeds", "direction [-]", "app/test_direction.cpp"},
    {"critical_speeds", "kind [-]", "app/test_direction.cpp"},
    {"damped", "direction [-]", "app/test_direction.cpp"},
    {"damped", "kind [-]", "app/test_direction.cpp"},
    {"undamped", "direction [-]", "app/test_direction.cpp"},
    {"undamped", "kind [-]", "app/test_direction.cpp"},
    {"onset", "direction [-]", "app/test_direction.cpp"},
    {"onset", "kind [-]", "app/test_direction.cpp"},
    {"modes", "direction [-]", "app/test_direction.cpp"},
    {"modes", "kind [-]", "app/test_direction.cpp"},
    {"onset", "above this speed [-]", "app/test_spectra.cpp"},
    {"modes", "forwardness [-]", "app/test_direction.cpp"},
    {"modes", "label [-]", "app/test_direction.cpp"},
    {"deflection", "u_x [m]", "app/test_keys_matter.cpp"},
    {"energy_parts", "kinetic: shaft [%]", "open: shares of a flexible shaft"},
    {"energy_parts", "strain: shaft [%]", "open: shares of a flexible shaft"},
    {"equilibria", "proved [-]", "app/test_static_stability.cpp"},
    {"history", "energy.gravity [J]", "app/test_energy_balance.cpp"},
    {"map_onset", "remark [-]", "open: words"},
    {"peaks", "amplitude 0-peak [m]", "the examples in tests/CMakeLists.txt, from the summary"},
    {"peaks", "motion 0-peak [m]", "app/test_figures.cpp"},
    {"peaks", "motion at [s]", "app/test_figures.cpp"},
    {"peaks", "time [s]", "the examples in tests/CMakeLists.txt, from the summary"},
    {"peaks", "amplitude [rad]", "open: peaks of harmonic responses"},
    {"peaks", "mesh error of amplitude [-]", "app/test_natural_decks.cpp"},
    {"peaks", "mesh error of amplification [-]", "app/test_natural_decks.cpp"},
    {"response", "bearing # force x [N]", "app/test_held_forces.cpp"},
    {"response", "largest torque in # [N.m]", "app/test_harmonic_limits.cpp"},
    {"response", "frequency [Hz]", "app/test_direction.cpp"},
    {"rolling", "angle [deg]", "app/test_rolling_loads.cpp"},
    {"rolling", "bearing [-]", "app/test_rolling_loads.cpp"},
    {"rolling", "element [-]", "app/test_rolling_loads.cpp"},
    {"rolling", "load [N]", "app/test_rolling_loads.cpp"},
    {"films", "bearing [-]", "app/test_hot_films.cpp"},
    {"films", "speed [rpm]", "app/test_hot_films.cpp"},
    {"films", "pad [-]", "app/test_hot_films.cpp"},
    {"films", "film load [N]", "app/test_hot_films.cpp"},
    {"films", "power loss [W]", "app/test_hot_films.cpp"},
    {"films", "inflow [m^3/s]", "app/test_hot_films.cpp"},
    {"films", "outflow [m^3/s]", "app/test_hot_films.cpp"},
    {"films", "side flow [m^3/s]", "app/test_hot_films.cpp"},
    {"films", "smallest film [m]", "app/test_hot_films.cpp"},
    {"films", "angle of smallest film [deg]", "app/test_hot_films.cpp"},
    {"films", "largest pressure [Pa]", "app/test_hot_films.cpp"},
    {"films", "angle of largest pressure [deg]", "app/test_hot_films.cpp"},
    {"films", "Reynolds number [-]", "app/test_hot_films.cpp"},
    {"films", "effective viscosity [Pa s]", "app/test_hot_films.cpp"},
    {"films", "effective temperature [degC]", "app/test_hot_films.cpp"},
    {"films", "error of hottest face [K]", "app/test_hot_films.cpp"},
    {"films", "axial error of pressure [-]", "app/test_recessed_journals.cpp"},
    {"films", "axial error of side flow [-]", "app/test_recessed_journals.cpp"},
    {"films", "oil in [degC]", "app/test_hot_films.cpp"},
    {"films", "oil out [degC]", "app/test_hot_films.cpp"},
    {"films", "hottest face [degC]", "app/test_hot_films.cpp"},
    {"films", "angle of hottest face [deg]", "app/test_hot_films.cpp"},
    {"films", "hottest oil [degC]", "app/test_hot_films.cpp"},
    {"films", "pad [degC]", "app/test_hot_films.cpp"},
    {"films", "journal [degC]", "app/test_hot_films.cpp"},
    {"films", "growth of clearance [m]", "app/test_hot_films.cpp"},
    {"films", "heat into pad [W]", "app/test_hot_films.cpp"},
    {"films", "heat into journal [W]", "app/test_hot_films.cpp"},
    {"films", "heat into oil [W]", "app/test_hot_films.cpp"},
    {"films", "hot oil in inflow [-]", "app/test_hot_films.cpp"},
    {"films", "heat returned [W]", "app/test_hot_films.cpp"},
    {"films", "oil about the pads [degC]", "app/test_hot_films.cpp"},
    {"films", "supply flow [m^3/s]", "app/test_hot_films.cpp"},
    {"pads", "bearing [-]", "app/test_tilting_pads.cpp"},
    {"pads", "speed [rpm]", "app/test_tilting_pads.cpp"},
    {"pads", "pad [-]", "app/test_tilting_pads.cpp"},
    {"pads", "pivot [deg]", "app/test_tilting_pads.cpp"},
    {"pads", "pad load [N]", "app/test_tilting_pads.cpp"},
    {"pads", "tilt [rad]", "app/test_tilting_pads.cpp"},
    {"pads", "pivot compression [m]", "app/test_tilting_pads.cpp"},
    {"pads", "pad eccentricity [-]", "app/test_tilting_pads.cpp"},
    {"pads", "smallest film [m]", "app/test_tilting_pads.cpp"},
    {"pads", "power loss [W]", "app/test_tilting_pads.cpp"},
    {"pads", "carries [-]", "app/test_tilting_pads.cpp"},
    {"pad_coefficients", "bearing [-]", "app/test_tilting_pads.cpp"},
    {"pad_coefficients", "speed [rpm]", "app/test_tilting_pads.cpp"},
    {"pad_coefficients", "frequency / speed [-]", "app/test_tilting_pads.cpp"},
    {"pad_coefficients", "frequency [Hz]", "app/test_tilting_pads.cpp"},
    {"pad_coefficients", "reduced kyy [N/m]", "app/test_tilting_pads.cpp"},
    {"pad_coefficients", "reduced kyz [N/m]", "app/test_tilting_pads.cpp"},
    {"pad_coefficients", "reduced kzy [N/m]", "app/test_tilting_pads.cpp"},
    {"pad_coefficients", "reduced kzz [N/m]", "app/test_tilting_pads.cpp"},
    {"pad_coefficients", "reduced cyy [N s/m]", "app/test_tilting_pads.cpp"},
    {"pad_coefficients", "reduced cyz [N s/m]", "app/test_tilting_pads.cpp"},
    {"pad_coefficients", "reduced czy [N s/m]", "app/test_tilting_pads.cpp"},
    {"pad_coefficients", "reduced czz [N s/m]", "app/test_tilting_pads.cpp"},
    {"full_coefficients", "bearing [-]", "app/test_tilting_pads.cpp"},
    {"full_coefficients", "speed [rpm]", "app/test_tilting_pads.cpp"},
    {"full_coefficients", "force along [-]", "app/test_tilting_pads.cpp"},
    {"full_coefficients", "motion [-]", "app/test_tilting_pads.cpp"},
    {"full_coefficients", "full k [N/m]", "app/test_tilting_pads.cpp"},
    {"full_coefficients", "full c [N s/m]", "app/test_tilting_pads.cpp"},
    {"full_coefficients", "full m [kg]", "app/test_tilting_pads.cpp"},
    {"rings", "bearing [-]", "app/test_floating_rings.cpp"},
    {"rings", "speed [rpm]", "app/test_floating_rings.cpp"},
    {"rings", "ring speed [rpm]", "app/test_floating_rings.cpp"},
    {"rings", "ring speed / speed [-]", "app/test_floating_rings.cpp"},
    {"rings", "ring y [m]", "app/test_floating_rings.cpp"},
    {"rings", "ring z [m]", "app/test_floating_rings.cpp"},
    {"rings", "inner eccentricity [-]", "app/test_floating_rings.cpp"},
    {"rings", "inner load [N]", "app/test_floating_rings.cpp"},
    {"rings", "inner clearance [m]", "app/test_floating_rings.cpp"},
    {"rings", "inner thinnest film [m]", "app/test_floating_rings.cpp"},
    {"rings", "inner power loss [W]", "app/test_floating_rings.cpp"},
    {"rings", "inner viscosity [Pa s]", "app/test_floating_rings.cpp"},
    {"rings", "inner temperature [degC]", "app/test_floating_rings.cpp"},
    {"rings", "inner flow [m^3/s]", "app/test_floating_rings.cpp"},
    {"rings", "outer eccentricity [-]", "app/test_floating_rings.cpp"},
    {"rings", "outer load [N]", "app/test_floating_rings.cpp"},
    {"rings", "outer clearance [m]", "app/test_floating_rings.cpp"},
    {"rings", "outer thinnest film [m]", "app/test_floating_rings.cpp"},
    {"rings", "outer power loss [W]", "app/test_floating_rings.cpp"},
    {"rings", "outer viscosity [Pa s]", "app/test_floating_rings.cpp"},
    {"rings", "outer temperature [degC]", "app/test_floating_rings.cpp"},
    {"rings", "outer flow [m^3/s]", "app/test_floating_rings.cpp"},
    {"rings", "torque on the ring [N m]", "app/test_floating_rings.cpp"},
    {"rings", "feed pressure of the inner film [Pa]", "app/test_floating_rings.cpp"},
    {"ring_coefficients", "bearing [-]", "app/test_floating_rings.cpp"},
    {"ring_coefficients", "speed [rpm]", "app/test_floating_rings.cpp"},
    {"ring_coefficients", "frequency / speed [-]", "app/test_floating_rings.cpp"},
    {"ring_coefficients", "frequency [Hz]", "app/test_floating_rings.cpp"},
    {"ring_coefficients", "reduced kyy [N/m]", "app/test_floating_rings.cpp"},
    {"ring_coefficients", "reduced kyz [N/m]", "app/test_floating_rings.cpp"},
    {"ring_coefficients", "reduced kzy [N/m]", "app/test_floating_rings.cpp"},
    {"ring_coefficients", "reduced kzz [N/m]", "app/test_floating_rings.cpp"},
    {"ring_coefficients", "reduced cyy [N s/m]", "app/test_floating_rings.cpp"},
    {"ring_coefficients", "reduced cyz [N s/m]", "app/test_floating_rings.cpp"},
    {"ring_coefficients", "reduced czy [N s/m]", "app/test_floating_rings.cpp"},
    {"ring_coefficients", "reduced czz [N s/m]", "app/test_floating_rings.cpp"},
    {"full_ring_coefficients", "bearing [-]", "app/test_floating_rings.cpp"},
    {"full_ring_coefficients", "speed [rpm]", "app/test_floating_rings.cpp"},
    {"full_ring_coefficients", "force along [-]", "app/test_floating_rings.cpp"},
    {"full_ring_coefficients", "motion [-]", "app/test_floating_rings.cpp"},
    {"full_ring_coefficients", "full k [N/m]", "app/test_floating_rings.cpp"},
    {"full_ring_coefficients", "full c [N s/m]", "app/test_floating_rings.cpp"},
    {"full_ring_coefficients", "full m [kg]", "app/test_floating_rings.cpp"},
    {"rolling_stiffness", "bearing [-]", "StiffnessOfABallBearingIsThatOfItsPlace"},
    {"rolling_stiffness", "force or moment [-]", "StiffnessOfABallBearingIsThatOfItsPlace"},
    {"rolling_stiffness", "per ry [N/rad, N m/rad]", "StiffnessOfABallBearingIsThatOfItsPlace"},
    {"rolling_stiffness", "per rz [N/rad, N m/rad]", "StiffnessOfABallBearingIsThatOfItsPlace"},
    {"rolling_stiffness", "per x [N/m, N]", "StiffnessOfABallBearingIsThatOfItsPlace"},
    {"rolling_stiffness", "per y [N/m, N]", "StiffnessOfABallBearingIsThatOfItsPlace"},
    {"rolling_stiffness", "per z [N/m, N]", "StiffnessOfABallBearingIsThatOfItsPlace"},
    {"tracking", "#.y 2X lag [deg]", "analysis/test_postprocess.cpp"},
    {"tracking", "#.z 2X lag [deg]", "analysis/test_postprocess.cpp"},
    {"tracking", "#.y envelope [m]", "analysis/test_postprocess.cpp"},
    {"tracking", "#.z envelope [m]", "analysis/test_postprocess.cpp"},
    {"verdicts", "certified [-]", "analysis/test_certificates.cpp"},
    {"verdicts", "neutral whirl modes [-]", "OnsetIsWhereGrowthIsZeroOnEveryMesh"},
    {"verdicts", "neutral within [1/s]", "OnsetIsWhereGrowthIsZeroOnEveryMesh"},
    {"verdicts", "roots counted up to [Hz]", "analysis/test_certificates.cpp"},
};

}  // namespace

// The list of columns is what the program writes: a new one needs a row above or a line here.
TEST(WrittenNumbers, EveryColumnIsReadByATest) {
  using Column = std::pair<std::string, std::string>;
  std::set<Column> read, written;
  for (const Elsewhere& e : elsewhere)
    read.insert({e.kind, e.heading});
  const auto decks = whirl::test::written_decks();
  const auto reads = [&](const auto& x) {
    read.insert({general(kind_of(x.file), decks.at(x.deck)), general(x.column, decks.at(x.deck))});
  };
  for (const Number& n : numbers)
    reads(n);
  for (const Word& w : words)
    reads(w);
  for (const auto& [name, deck] : decks) {
    const DeckRun run(deck);
    for (const Word& w : words) {
      if (w.deck != name) continue;
      const auto cells = cells_of(run.folder / "r" / w.file);
      ASSERT_LT(w.row + 1, cells.size()) << name << " " << w.file;
      const std::size_t c = run.csv(w.file).column(w.column);
      EXPECT_EQ(cells[w.row + 1].at(c), w.expected) << name << ", " << w.file << ", " << w.column;
    }
    for (const auto& entry : std::filesystem::directory_iterator(run.folder / "r"))
      if (entry.path().extension() == ".csv")
        for (const std::string& heading : run.csv(entry.path().filename()).names)
          written.insert({general(kind_of(entry.path().filename()), deck), general(heading, deck)});
  }
  for (const Column& c : written)
    EXPECT_TRUE(read.contains(c)) << "{\"" << c.first << "\", \"" << c.second << "\", \"\"},";
}
