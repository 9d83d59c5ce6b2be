;; A robot that only speaks ROS 2, behind saphira-ros2-base (agents/ros2/README.md): a round base of the size and the
;; speed of a TurtleBot, with a laser. Copy this file for your own robot. Keywords: README.md.

Class     ROS
Subclass  ros2
Protocol  p2os

;; Values of one unit of the packets between that program and the bridge
AngleConvFactor  0.00153398 ; rad
DistConvFactor   1          ; mm
VelConvFactor    1          ; mm/s
RangeConvFactor  1          ; mm
DiffConvFactor   0.008      ; rad of turn per mm of half the difference of the wheel ways: 2 / their distance
Vel2Divisor      20         ; mm/s

;; To be adapted: the hull, and what cmd_vel may ask for
RobotRadius      180        ; mm
MaxVelocity      300        ; mm/s
MaxRVelocity     90         ; deg/s
Acceleration     300        ; mm/s2
Deceleration     500        ; mm/s2
RotAcceleration  150        ; deg/s2
RotDeceleration  150        ; deg/s2

;; The battery; without battery_state they do not matter
Battery          12.6       ; V
LowBattery       11.0       ; V
ShutdownVolts    10.5       ; V

;; Sonar buffers of the LPS
FrontBuffer      30         ; readings
SideBuffer       40         ; readings on each side
FrontMaxRange    2500       ; mm

;; Sectors of the laser's scan, from near the robot's middle: at most 15 degrees apart, so that they leave no gap. For
;; range sensors: a line for each, with its place, as tf_static has it. No sensor may reach less far than SonarMaxRange.
SonarMaxRange    3400       ; mm
SonarPeriod      33         ; ms: with eight arrays, all within a scan of 0.1 s
SonarArrays      8
SonarNum         24
;;         #     x     y    th    mm, mm, degrees
SonarUnit  0    10     0     0
SonarUnit  1    10     3    15
SonarUnit  2     9     5    30
SonarUnit  3     7     7    45
SonarUnit  4     5     9    60
SonarUnit  5     3    10    75
SonarUnit  6     0    10    90
SonarUnit  7    -3    10   105
SonarUnit  8    -5     9   120
SonarUnit  9    -7     7   135
SonarUnit 10    -9     5   150
SonarUnit 11   -10     3   165
SonarUnit 12   -10     0   180
SonarUnit 13   -10    -3  -165
SonarUnit 14    -9    -5  -150
SonarUnit 15    -7    -7  -135
SonarUnit 16    -5    -9  -120
SonarUnit 17    -3   -10  -105
SonarUnit 18     0   -10   -90
SonarUnit 19     3   -10   -75
SonarUnit 20     5    -9   -60
SonarUnit 21     7    -7   -45
SonarUnit 22     9    -5   -30
SonarUnit 23    10    -3   -15
