#pragma once
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

// Records written by the descriptions of their formats, without the readers' help.
namespace uplift::sample {

/// A text, and the numbers that stand in it, read back by strtod.
struct Written {
  std::string text;
  std::vector<double> numbers;
};

/// A tone that swells and dies, with numbers of both signs and of every size.
inline std::vector<double> tone(std::size_t points, double peak) {
  std::vector<double> values;
  for (std::size_t i = 0; i < points; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(points);
    values.push_back(peak * std::sin(61 * t) * t * std::exp(1 - 4 * t * t));
  }
  return values;
}

/// Rows of `per_row` numbers, each printed as fmt's `form`.
inline void add_rows(Written& out, const std::vector<double>& values, std::size_t per_row, const std::string& form) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string field = fmt::format(fmt::runtime(form), values[i]);
    out.numbers.push_back(std::strtod(field.c_str(), nullptr));
    out.text += field;
    if ((i + 1) % per_row == 0 || i + 1 == values.size()) out.text += "\n";
  }
}

inline Written peer(const std::vector<double>& values, const std::string& counts, const std::string& quantity = "ACCELERATION",
                    const std::string& unit = "G") {
  Written out{"PEER NGA STRONG MOTION DATABASE RECORD\nImperial Valley-06, 10/15/1979, El Centro Array #6, 230\n" + quantity +
                  " TIME SERIES IN UNITS OF " + unit + "\n" + counts + "\n",
              {}};
  add_rows(out, values, 5, "{:15.7E}");
  return out;
}

inline Written esm(const std::vector<double>& values, double step, const std::string& type = "ACCELERATION",
                   const std::string& unit = "cm/s^2") {
  Written out{
      fmt::format("EVENT_NAME: EMILIA_ROMAGNA\nEVENT_DATE_YYYYMMDD: 20120529\nNETWORK: IT\nSTATION_CODE: MRN\nSTATION_NAME: MIRANDOLA\n"
                  "VS30_M/S: 208\nSAMPLING_INTERVAL_S: {:.6f}\nNDATA: {}\nSTREAM: HNE\nUNITS: {}\nDATA_TYPE: {}\nUSER5:\n",
                  step, values.size(), unit, type),
      {}};
  add_rows(out, values, 1, "{:12.6f}");
  return out;
}

/// Counts, whole numbers.
inline Written knet(const std::vector<double>& counts, int hertz, const std::string& direction,
                    const std::string& scale = "3920(gal)/6182761") {
  Written out{fmt::format("Origin Time       2011/03/11 14:46:00\nLat.              38.103\nLong.             142.860\nDepth. (km)       "
                          "24\nMag.              9.0\n"
                          "Station Code      IBR011\nStation Lat.      36.1256\nStation Long.     140.0901\nStation Height(m) 27\nRecord "
                          "Time       2011/03/11 14:47:21\n"
                          "Sampling Freq(Hz) {}Hz\nDuration Time(s)  {}\nDir.              {}\nScale Factor      {}\nMax. Acc. (gal)   "
                          "\nLast Correction   2011/03/11 14:47:06\n"
                          "Memo.             \n",
                          hertz, counts.size() / static_cast<std::size_t>(hertz), direction, scale),
              {}};
  std::vector<double> whole;
  for (const double count : counts) whole.push_back(std::round(count));
  add_rows(out, whole, 8, "{:9.0f}");
  return out;
}

inline std::string header_rows(const std::vector<double>& values, std::size_t per_row, const std::string& form) {
  Written out;
  add_rows(out, values, per_row, form);
  return out.text;
}

/// One channel of COSMOS version 1.20.
inline Written cosmos(const std::vector<double>& values, double step_ms, double peak, const std::string& level = "Corrected",
                      const std::string& units = "cm/sec2(04)") {
  std::vector<double> integers(100, -999), reals(100, -999);
  integers[53] = 340;
  reals[33] = 0.02;  // of the recorder, not of these values
  reals[61] = step_ms;
  reals[63] = peak;
  Written out{level +
                  " acceleration    (Format v01.20 with 13 text lines) Src: test\nRecord of Yucaipa Earthquake of June 16, 2005\n"
                  "Hypocenter: 34.0580  -117.0110  H= 12km\nOrigin: 06/16/2005, 20:53:26.1 UTC\nStatn No: 01-23075  Code:CE-J2236  CDMG "
                  "Yucaipa - Bryant & Oak Glen\n"
                  "Coords: 34.0460 -117.0350\nRecorder: SSA-2\nRcrd start time:06/16/2005\nSta Cha:  1: 340 deg (Rcrdr Chan  1) Location: "
                  "ground\nRaw record length = 70 sec\n"
                  "Processed: 06/17/2005\nRecord filtered below 0.30  Hz\nValues used when parameter or data value is unknown/unspecified: "
                  "  -999, -999.0\n"
                  " 100 Integer-header values follow on  10 lines, Format= (10I8)\n" +
                  header_rows(integers, 10, "{:8.0f}") + " 100 Real-header values follow on  17 lines, Format= (6F13.6)\n" +
                  header_rows(reals, 6, "{:13.6f}") + "  1 Comment line(s) follow, each starting with a \"|\":\n| a comment\n" +
                  fmt::format("{:7}  acceleration pts, approx  {:.0f} secs, units={},Format=(8F10.5)\n", values.size(),
                              static_cast<double>(values.size()) * step_ms / 1000, units),
              {}};
  add_rows(out, values, 8, "{:10.5f}");
  out.text += "End-of-data for Chan  1 acceleration\n";
  return out;
}

/// One channel of CSMIP's V2: acceleration, and what is made of it.
inline Written csmip_v2(const std::vector<double>& values, double step, double peak) {
  Written out{
      fmt::format(
          "Corrected accelerogram   58667-L2866-14236.52       Chan  1:  H1         from   \nUncorrected Accelerogram Data             "
          "Processed: 08/24/14\n"
          "Rcrd of Sun Aug 24, 2014 03:20:33.0 PDT               (Avol1 v0.8, 5/14 CSMIP)  \nStation No. 58667   37.973N, 122.038W    Etna "
          "   s/n 2866\n"
          "Concord - Clayton & Ellis                 CGS   Data: Acceleration\nChan  1:  360 Deg\n"
          "  {0} points of instrument- and baseline-corrected accel, veloc and displ data \nAt equally-spaced intervals of    {1:.3f}  "
          "sec.\n"
          "Peak acceleration =    {2:.3f}    cm/sec/sec  at   32.570   sec.\n"
          "    1  100    1    3    3  200    1    3    1   24   12 2866    058667   41    0\n  .0101833  .6400000 75.000000  .0040522\n"
          "  {0} points of accel data equally spaced at  {1:.3f} sec, in cm/sec2. (8f10.6)    \n",
          values.size(), step, peak),
      {}};
  add_rows(out, values, 8, "{:10.5f}");
  out.text += fmt::format("  {} points of veloc data equally spaced at  {:.3f} sec, in cm/sec. (8f10.6)\n", values.size(), step);
  Written velocity;
  add_rows(velocity, std::vector<double>(values.size(), 1.0), 8, "{:10.6f}");
  out.text += velocity.text + "/&  ----------  End of data for channel  1   ----------\n";
  return out;
}

/// CSMIP's V1: in g, the step as a rate, fields without a blank between them.
inline Written csmip_v1(const std::vector<double>& values, int rate) {
  Written out{
      fmt::format(
          "Uncorrected Accelerogram Data             Processed: 02/13/12, CGS  146be002\nRecord of Mon Feb 13, 2012 13:06:45.0 PST         "
          "    (Avol1 v9.2)\n"
          "Station No. 89146   40.941N, 123.633W      Etna  s/n 2500\nWillow Creek                              CGS\nChan  1: 90 Deg\n"
          "No. of Points =  {0}  Record Length = 66.000 sec   at {1} Samples/sec\n 1.0000000 1.3481140\n"
          " {0} Accelerogram points at {1} pts/sec in units of g .      Format: (8f9.6)  \n",
          values.size(), rate),
      {}};
  add_rows(out, values, 8, "{:9.6f}");
  return out;
}

inline Written smc(const std::vector<double>& values, double rate, const std::string& type = "2 CORRECTED ACCELEROGRAM",
                   double largest = 1.7e38, double smallest = 1.7e38) {
  std::vector<double> integers(48, -32768), reals(50, 1.7e38);
  integers[13] = 225;
  integers[15] = 2;
  integers[16] = static_cast<double>(values.size());
  reals[1] = rate;
  reals[29] = largest;
  reals[31] = smallest;
  Written out{type +
                  "\n*\nSOB0E\n     1989  10  18    0004 Loma Prieta, CA\nMoment Mag=      7.1\nstation = San Francisco, 575 Market, 42n "
                  "component=    225\n"
                  "epicentral dist =     96.0       pk acc =    180.3\ninst type=CRA-1      data source = USGS\n*\n*\n*\n" +
                  header_rows(integers, 8, "{:10.0f}") + header_rows(reals, 5, "{:15.7E}") + "|\n|USGS Open-File Report 89-568, 85 p.\n",
              {}};
  add_rows(out, values, 8, "{:10.4f}");
  return out;
}

}  // namespace uplift::sample
